/* SPDX-License-Identifier: MIT */
/*
 * From rays to pixels: fetches rows of the grid, filters, upsamples, packs.
 *
 * A rectangle of pixels needs some columns of the grid and, with a kernel of
 * radius r, r more on either side. Its rows are fetched from top to bottom,
 * each once, into a ring of as many as the kernel has taps. The column pass
 * makes one line of them, the row pass works in that line, and two such lines
 * are upsampled. Nothing depends on where the rectangle begins: any cutting
 * gives the same pixels.
 *
 * With colour there is the same once more for layer 1: each of its samples is
 * `apart` behind that of layer 0.
 */
#include "brume_filter.h"

#if BRUME_WITH_TEMPORAL || BRUME_WITH_SPATIAL || BRUME_WITH_RESOLUTION

/* One call of brume_show_rect. */
struct show {
    const struct brume_frame *frame;
    const struct brume_state *state; /* or NULL */
    uint32_t resolution;             /* log2 of pixels per ray, per side */
    uint32_t radius;                 /* of the kernel; 0: none */
    uint32_t first, columns;         /* of the grid, that pixels need */
    uint32_t from, fetched;          /* of the grid, those fetched */
    uint32_t next;                   /* row of the grid to be fetched next */
    int pixel_format;
    /* All in the caller's scratch memory: */
    struct brume_radiance *span;  /* BRUME_SPAN of them */
    struct brume_sample *line[2]; /* see line_of */
    struct brume_sample *ring;    /* a row per tap, `fetched` samples each */
    uint32_t oldest;              /* of the rows in the ring */
    uint32_t apart;               /* samples between the layers; with colour */
};

static uint32_t radius_of(const struct brume_frame *f)
{
#if BRUME_WITH_SPATIAL
    return brume_filter_radius(f);
#else
    (void)f;
    return 0;
#endif
}

static uint32_t smaller(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

/// Rows of the grid ///

/* A layer of the first n rays of s->span. */
BRUME_INLINE void take_span(const struct show *s, uint32_t n, uint32_t layer,
                            struct brume_sample *out)
{
    const uint32_t log2 = brume_light_log2(s->frame);
    for (uint32_t k = 0; k < n; k++)
        *out++ = brume_sample_from(&s->span[k], log2, layer);
}

/* s->fetched rays of row y, marched here when there is no state. */
static void fetch_row(const struct show *s, uint32_t y,
                      struct brume_sample *out)
{
#if BRUME_WITH_TEMPORAL
    if (s->state != NULL) {
        brume_history_row(s->frame, s->state, s->from, y, s->fetched, out);
        if (BRUME_WITH_COLOUR && brume_has_colour(s->frame))
            brume_colours_row(s->frame, s->state, s->from, y, s->fetched,
                              out + s->apart);
        return;
    }
#endif
    for (uint32_t i = 0; i < s->fetched; i += BRUME_SPAN) {
        uint32_t n = smaller(s->fetched - i, BRUME_SPAN);
        brume_march_span(s->frame, s->from + i, y, n, s->span);
        take_span(s, n, 0, out);
        if (brume_has_colour(s->frame))
            take_span(s, n, 1, out + s->apart);
        out += n;
    }
}

#if BRUME_WITH_SPATIAL
/* Fetches up to row `last`; each new row takes the place of the oldest. */
static void fill_ring(struct show *s, uint32_t last)
{
    for (; s->next <= last; s->next++) {
        fetch_row(s, s->next, s->ring + s->oldest * s->fetched);
        s->oldest = s->oldest == 2u * s->radius ? 0 : s->oldest + 1u;
    }
}

/* Row y of the grid, of the last ones that were fetched. */
static const struct brume_sample *ring_row(const struct show *s, uint32_t y)
{
    const uint32_t taps = 2u * s->radius + 1u;
    uint32_t place = s->oldest + taps + y - s->next; /* < 2 taps */
    return s->ring + (place < taps ? place : place - taps) * s->fetched;
}

/* Repeats the first and the last of the samples from .. to - 1 of a line of
 * n. */
static void pad_line(struct brume_sample *line, uint32_t from, uint32_t to,
                     uint32_t n)
{
    for (uint32_t i = 0; i < from; i++)
        line[i] = line[from];
    for (uint32_t i = to; i < n; i++)
        line[i] = line[to - 1u];
}

BRUME_INLINE void filter(const struct show *s,
                         const struct brume_sample *const *tap,
                         struct brume_sample *out, uint32_t n)
{
    if (BRUME_WITH_COLOUR && brume_has_colour(s->frame))
        brume_filter_colours(s->frame, tap, out, n, s->apart);
    else
        brume_filter_row(s->frame, tap, out, n);
}

/* Row y, filtered; beyond its edges the grid goes on as it ends. Rows must be
 * asked for from top to bottom. */
static void filter_row(struct show *s, uint32_t y, struct brume_sample *out)
{
    const struct brume_sample *tap[BRUME_MAX_TAPS];
    const uint32_t taps = 2u * s->radius + 1u;
    const uint32_t bottom = s->frame->grid[1] - 1u;
    const uint32_t pad = s->from + s->radius - s->first;
    fill_ring(s, smaller(y + s->radius, bottom));
    for (uint32_t k = 0; k < taps; k++) {
        uint32_t row = y + k > s->radius ? y + k - s->radius : 0;
        tap[k] = ring_row(s, smaller(row, bottom));
    }
    filter(s, tap, out + pad, s->fetched);
    pad_line(out, pad, pad + s->fetched, s->columns + 2u * s->radius);
    if (brume_has_colour(s->frame))
        pad_line(out + s->apart, pad, pad + s->fetched,
                 s->columns + 2u * s->radius);
    for (uint32_t k = 0; k < taps; k++)
        tap[k] = out + k;
    filter(s, tap, out, s->columns);
}
#endif

/* s->columns rays of row y, filtered or not. */
static void make_row(struct show *s, uint32_t y, struct brume_sample *out)
{
#if BRUME_WITH_SPATIAL
    if (s->radius != 0) {
        filter_row(s, y, out);
        return;
    }
#endif
    fetch_row(s, y, out);
}

/// A ray per pixel ///

/* Layer 1 of the first n rays of s->span. */
BRUME_INLINE void give_colours(const struct show *s,
                               const struct brume_sample *in, uint32_t n,
                               uint32_t log2)
{
#if BRUME_WITH_COLOUR
    for (uint32_t k = 0; k < n; k++) {
        s->span[k].green = light_of_sample(in[k].light, log2);
        s->span[k].blue = light_of_sample(in[k].transmittance, log2);
    }
#else
    (void)s, (void)in, (void)n, (void)log2;
#endif
}

static void pack_row(const struct show *s, uint32_t x, uint32_t y,
                     const struct brume_sample *in, uint32_t n, uint8_t *dst)
{
    const uint32_t log2 = brume_light_log2(s->frame);
    for (uint32_t i = 0; i < n; i += BRUME_SPAN) {
        uint32_t m = smaller(n - i, BRUME_SPAN);
        for (uint32_t k = 0; k < m; k++) {
            s->span[k].light = light_of_sample(in[i + k].light, log2);
            s->span[k].transmittance = of_sample(in[i + k].transmittance);
        }
        if (brume_has_colour(s->frame))
            give_colours(s, in + i + s->apart, m, log2);
        brume_pack_span(s->frame, x + i, y, s->span, m, s->pixel_format,
                        dst + brume_pixel_offset(s->pixel_format, i));
    }
}

/* Without a kernel a row is shown piece by piece. */
static void show_unfiltered(struct show *s, uint32_t y, uint32_t w,
                            uint8_t *dst)
{
    const uint32_t end = s->first + w;
    for (s->from = s->first; s->from < end; s->from += s->fetched) {
        s->fetched = smaller(end - s->from, BRUME_SPAN);
        fetch_row(s, y, s->line[0]);
        pack_row(s, s->from, y, s->line[0], s->fetched,
                 dst + brume_pixel_offset(s->pixel_format, s->from - s->first));
    }
}

static void show_full(struct show *s, uint32_t y, uint32_t w, uint32_t h,
                      uint8_t *dst, size_t stride)
{
    for (uint32_t j = 0; j < h; j++, dst += stride) {
        if (s->radius == 0) {
            show_unfiltered(s, y + j, w, dst);
            continue;
        }
        make_row(s, y + j, s->line[0]);
        pack_row(s, s->first, y + j, s->line[0], w, dst);
    }
}

/// Pixels between rays ///

#if BRUME_WITH_RESOLUTION
/* n pixels from column x, between a row and the one below it, line[0]. */
BRUME_INLINE void blend_rows(const struct show *s,
                             const struct brume_sample *above, uint32_t weight,
                             uint32_t x, uint32_t n)
{
    if (BRUME_WITH_COLOUR && brume_has_colour(s->frame))
        brume_upsample_colours(s->frame, above, s->line[0], s->first, weight, x,
                               n, s->span, s->apart);
    else
        brume_upsample_span(s->frame, above, s->line[0], s->first, weight, x, n,
                            s->span);
}
#endif

/* Row `made` of the grid is in line[0], the one before it in line[1]. */
static void show_upsampled(struct show *s, uint32_t x, uint32_t y, uint32_t w,
                           uint32_t h, uint8_t *dst, size_t stride)
{
#if BRUME_WITH_RESOLUTION
    uint32_t made = brume_between(s->frame, y, 1).before;
    make_row(s, made, s->line[0]);
    for (uint32_t j = 0; j < h; j++, dst += stride) {
        struct brume_between row = brume_between(s->frame, y + j, 1);
        for (; made < row.after; made++) {
            struct brume_sample *line = s->line[1];
            s->line[1] = s->line[0];
            s->line[0] = line;
            make_row(s, made + 1u, line);
        }
        const uint32_t above = row.before == row.after ? 0 : 1;
        for (uint32_t i = 0; i < w; i += BRUME_SPAN) {
            uint32_t n = smaller(w - i, BRUME_SPAN);
            blend_rows(s, s->line[above], row.weight, x + i, n);
            brume_pack_span(s->frame, x + i, y + j, s->span, n, s->pixel_format,
                            dst + brume_pixel_offset(s->pixel_format, i));
        }
    }
#else
    (void)s, (void)x, (void)y, (void)w, (void)h, (void)dst, (void)stride;
#endif
}

/// Rectangles ///

static void set_frame(struct show *s, const struct brume_frame *frame)
{
    s->frame = frame;
    s->resolution = brume_resolution_of(frame);
    s->radius = radius_of(frame);
}

/* What pixels (x .. x + w - 1, y ..) need of the grid. */
static void set_rays(struct show *s, uint32_t x, uint32_t y, uint32_t w)
{
    const uint32_t last = brume_between(s->frame, x + w - 1u, 0).after;
    const uint32_t top = brume_between(s->frame, y, 1).before;
    const uint32_t end = s->frame->grid[0] - 1u;
    s->first = brume_between(s->frame, x, 0).before;
    s->columns = last - s->first + 1u;
    s->from = s->first > s->radius ? s->first - s->radius : 0;
    s->fetched = smaller(last + s->radius, end) - s->from + 1u;
    s->next = top > s->radius ? top - s->radius : 0;
}

/* Samples in a line: as the row pass needs them, or a piece of a row. */
static uint32_t line_of(const struct show *s)
{
    return s->radius == 0 && s->resolution == 0
               ? smaller(s->columns, BRUME_SPAN)
               : s->columns + 2u * s->radius;
}

static uint32_t lines_of(const struct show *s)
{
    return s->resolution != 0 ? 2 : 1;
}

static uint32_t rows_of(const struct show *s)
{
    return s->radius != 0 ? 2u * s->radius + 1u : 0;
}

/* Samples of a layer, in lines and ring. */
static size_t layer_of(const struct show *s)
{
    return (size_t)line_of(s) * lines_of(s) + (size_t)s->fetched * rows_of(s);
}

static void set_work(struct show *s, void *work)
{
    s->span = work;
    struct brume_sample *to = (void *)(s->span + BRUME_SPAN);
    for (uint32_t i = 0; i < lines_of(s); i++, to += line_of(s))
        s->line[i] = to;
    s->ring = to;
    s->oldest = 0;
    if (brume_has_colour(s->frame))
        s->apart = (uint32_t)layer_of(s);
}

size_t brume_work_bytes(const struct brume_frame *frame, unsigned w)
{
    struct show s;
    if (frame == NULL)
        return 0;
    set_frame(&s, frame);
    /* Wherever they begin, w pixels lie on at most (w - 2) / 2^r + 2 rays, and
     * one more is blended in. */
    const uint32_t r = s.resolution;
    s.columns = smaller(w, frame->width);
    if (r != 0)
        s.columns = ((s.columns + (1u << r) - 2u) >> r) + 2u;
    s.columns = smaller(s.columns, frame->grid[0]);
    s.fetched = smaller(s.columns + 2u * s.radius, frame->grid[0]);
    /* < 2^21 */
    size_t layers = brume_has_colour(frame) ? 2 : 1;
    return BRUME_SPAN * sizeof *s.span +
           layer_of(&s) * layers * sizeof **s.line;
}

/* Has the state what the frame needs? Without one, that is all the rays of
 * the grid, and of no other frame. */
static bool is_usable(const struct brume_frame *f, const struct brume_state *s)
{
#if BRUME_WITH_TEMPORAL
    if (s == NULL)
        return f->temporal == BRUME_TEMPORAL_NONE &&
               f->update == BRUME_UPDATE_ALL;
    return brume_state_fits(s, f);
#else
    (void)f;
    return s == NULL;
#endif
}

int brume_show_rect(const struct brume_frame *frame,
                    const struct brume_state *state, unsigned x, unsigned y,
                    unsigned w, unsigned h, int pixel_format, void *dst,
                    size_t stride, void *work, size_t work_size)
{
    struct show s;
    if (frame == NULL || dst == NULL || work == NULL)
        return BRUME_ERR_NULL;
    const uint16_t image[2] = {frame->width, frame->height};
    int err = brume_pixels_check(pixel_format, x, w, h, stride);
    if (err)
        return err;
    if (!brume_rect_fits(image, x, y, w, h))
        return BRUME_ERR_RECT;
    if (!is_usable(frame, state) || ((uintptr_t)work & 3u) != 0 ||
        work_size < brume_work_bytes(frame, w))
        return BRUME_ERR_STATE;
    if (w == 0 || h == 0)
        return BRUME_OK;
    set_frame(&s, frame);
    s.state = state;
    s.pixel_format = pixel_format;
    set_rays(&s, x, y, w);
    set_work(&s, work);
    if (s.resolution != 0)
        show_upsampled(&s, x, y, w, h, dst, stride);
    else
        show_full(&s, y, w, h, dst, stride);
    return BRUME_OK;
}

#endif
