/* SPDX-License-Identifier: MIT */
/*
 * Coloured light through the passes: every channel is treated as grey light
 * is, by all kinds of history, filters and upsampling; none sees another; and
 * light beyond 1 is kept to 2^-13. Rays are stored, not marched: their values
 * are chosen here.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "brume_inner.h"
#include "support/asset_builder.h"
#include "support/passes.h"
#include "tap.h"

enum { W = 21, H = 18, PIXELS = W * H, FRAMES = 5, GUARD = 64 };
#define MARK 0xa5
static struct brume_volume s_volume;

/* lowbias32, as a source of inputs. */
static uint32_t hash(uint32_t h)
{
    h = (h ^ h >> 16) * 0x7feb352du;
    h = (h ^ h >> 15) * 0x846ca68bu;
    return h ^ h >> 16;
}

static void *allocate(size_t size)
{
    void *p = malloc(size);
    if (p == NULL)
        abort();
    return p;
}

/// Settings ///

struct setting {
    int temporal, clamp, fetch, bits, update, resolution, upsample, filter;
};

/* taa counts six times: with every clamp and fetch. */
enum { KINDS = 3 + 6, SETTINGS = KINDS * 2 * 3 * 5 * 4 };

static struct setting setting_of(int i)
{
    static const int k_temporal[] = {BRUME_TEMPORAL_NONE, BRUME_EMA,
                                     BRUME_WINDOW};
    int kind = i % KINDS, scale = i / (KINDS * 6) % 5;
    struct setting t = {BRUME_TAA,           kind % 3,
                        kind / 3 - 1,        i / KINDS % 2 ? 16 : 8,
                        i / (KINDS * 2) % 3, (scale + 1) / 2,
                        scale & 1,           i / (KINDS * 30)};
    if (kind < 3) {
        t.temporal = k_temporal[kind];
        t.clamp = t.fetch = 0;
    }
    return t;
}

/* A camera that moves, and a white background: a pixel shows transmittance
 * too. */
static struct brume_scene scene_of(const struct setting *t, uint32_t frame)
{
    static const uint8_t k_spatial[] = {BRUME_SPATIAL_NONE, BRUME_GAUSS1,
                                        BRUME_BOX5, BRUME_BILATERAL15};
    struct brume_scene s;
    brume_scene_default(&s, &s_volume);
    s.width = W;
    s.height = H;
    s.frame = frame;
    s.eye[0] += (int32_t)frame * 90000;
    s.eye[2] -= (int32_t)frame * 70000;
    s.output = BRUME_LINEAR;
    s.background[0] = s.background[1] = s.background[2] = 0x10000;
    s.temporal = (uint8_t)t->temporal;
    s.clamp = (uint8_t)t->clamp;
    s.fetch = (uint8_t)t->fetch;
    s.history_bits = (uint8_t)t->bits;
    s.window = 3;
    s.update = (uint8_t)t->update;
    s.resolution = (uint8_t)t->resolution;
    s.upsample = (uint8_t)t->upsample;
    s.spatial = k_spatial[t->filter];
    s.edge_falloff = t->filter >= 2 ? 0x20000 : 0;
    return s;
}

/* Light that has colour, and light that has none. */
static const struct brume_lighting k_coloured = {
    .sun_colour = {0x10000, 0xc000, 0x8000}};
static const struct brume_lighting k_white = {
    .sun_colour = {0x10000, 0x10000, 0x10000}};

/// Rays ///

/* Values 0 .. 65536, of which the frames before know something: around what
 * changes slowly over the image and not with time. Light + transmittance <= 1:
 * no pixel is saturated. */
static void make_rays(struct brume_radiance out[PIXELS], uint32_t frame,
                      uint32_t seed)
{
    for (uint32_t i = 0; i < PIXELS; i++) {
        uint32_t h[4], steady = hash(i / 7u);
        for (uint32_t k = 0; k < 4; k++)
            h[k] = hash(seed + 4u * (i + frame * PIXELS) + k);
        uint32_t t = h[0] % 9u == 0 ? 0x10000u : (steady + h[0]) % 0x8000u;
        uint32_t most = 0x10000u - t;
        out[i].transmittance = t;
        out[i].light = (steady % 0x6000u + h[1] % 0x2000u) % (most + 1u);
        out[i].green = (steady % 0x5000u + h[2] % 0x3000u) % (most + 1u);
        out[i].blue = (steady % 0x7000u + h[3] % 0x1000u) % (most + 1u);
        out[i].depth = t == 0x10000u ? BRUME_NO_DEPTH
                                     : 46000u + steady % 128u + h[0] % 32u;
    }
}

static void move(struct brume_radiance *r, const int from[3])
{
    const uint32_t v[3] = {r->light, r->green, r->blue};
    r->light = v[from[0]];
    r->green = v[from[1]];
    r->blue = v[from[2]];
}

/// Sequences ///

typedef uint16_t picture[PIXELS][3];

static void begin(struct passes *p, const struct setting *t, uint32_t frame,
                  const struct brume_lighting *lighting)
{
    struct brume_scene s = scene_of(t, frame);
    s.lighting = lighting;
    passes_begin(p, &s_volume, &s);
    if (p->frame.lit.colour != (lighting == &k_coloured))
        abort();
}

/* All frames of a setting: with channels moved, `changed` of them (if any)
 * made of other numbers. */
static void draw(const struct setting *t, const struct brume_lighting *lighting,
                 const int from[3], int changed, picture out[FRAMES])
{
    static struct brume_radiance in[PIXELS], other[PIXELS];
    struct passes p = {0};
    for (uint32_t f = 0; f < FRAMES; f++) {
        make_rays(in, f, 1);
        make_rays(other, f, 77777);
        for (int i = 0; i < PIXELS; i++) {
            if (changed == 0)
                in[i].light = other[i].light;
            if (changed == 2)
                in[i].blue = other[i].blue;
            move(&in[i], from);
        }
        begin(&p, t, f, lighting);
        passes_store(&p, in);
        passes_show(&p, BRUME_RGB161616, out[f]);
    }
    passes_free(&p);
}

static const int k_same[3] = {0, 1, 2};

/* Channel c of one is channel d of the other. */
static bool are_equal(picture a[], int c, picture b[], int d, int frames)
{
    for (int f = 0; f < frames; f++)
        for (int i = 0; i < PIXELS; i++)
            if (a[f][i][c] != b[f][i][d])
                return false;
    return true;
}

/* Grey rays in three channels: each is what it is without colour. And what is
 * drawn depends on the frames before. */
static void test_grey(void)
{
    static picture grey[FRAMES], colour[FRAMES], fresh[FRAMES];
    const int from[3] = {1, 1, 1};
    int differ = 0, alone = 0;
    for (int i = 0; i < SETTINGS; i++) {
        struct setting t = setting_of(i), none = t;
        draw(&t, NULL, from, -1, grey);
        draw(&t, &k_coloured, from, -1, colour);
        differ += memcmp(grey, colour, sizeof grey) != 0;
        draw(&t, &k_white, from, -1, colour);
        differ += memcmp(grey, colour, sizeof grey) != 0;
        none.temporal = BRUME_TEMPORAL_NONE;
        draw(&none, NULL, from, -1, fresh);
        alone += t.temporal != BRUME_TEMPORAL_NONE &&
                 memcmp(grey[FRAMES - 1], fresh[FRAMES - 1], sizeof *grey) == 0;
    }
    tap_check(differ == 0,
              "grey as red, green and blue: the bytes of grey, %d settings",
              SETTINGS);
    tap_check(alone == 0, "all of them with history");
}

/* Two permutations that all others are made of. */
static void test_permutations(void)
{
    static const int k_from[2][3] = {{1, 2, 0}, {1, 0, 2}};
    static picture a[FRAMES], b[FRAMES];
    int differ = 0, grey = 0;
    for (int i = 0; i < SETTINGS; i++) {
        struct setting t = setting_of(i);
        draw(&t, &k_coloured, k_same, -1, a);
        grey += are_equal(a, 0, a, 1, FRAMES) || are_equal(a, 1, a, 2, FRAMES);
        for (int k = 0; k < 2; k++) {
            draw(&t, &k_coloured, k_from[k], -1, b);
            for (int c = 0; c < 3; c++)
                differ += !are_equal(b, c, a, k_from[k][c], FRAMES);
        }
    }
    tap_check(differ == 0, "permuted rays give permuted pictures");
    tap_check(grey == 0, "none of which is grey");
}

/* Only clipping by variance joins channels: it moves the whole colour by the
 * share that the channel with the least room allows. */
static void test_independence(void)
{
    static picture a[FRAMES], b[FRAMES];
    int red = 0, blue = 0, seen = 0, drawn = 0;
    for (int i = 0; i < SETTINGS; i++) {
        struct setting t = setting_of(i);
        if (t.temporal == BRUME_TAA && t.clamp == BRUME_CLAMP_VARIANCE)
            continue;
        draw(&t, &k_coloured, k_same, -1, a);
        draw(&t, &k_coloured, k_same, 2, b);
        blue +=
            !are_equal(a, 0, b, 0, FRAMES) || !are_equal(a, 1, b, 1, FRAMES);
        seen += !are_equal(a, 2, b, 2, FRAMES);
        draw(&t, &k_coloured, k_same, 0, b);
        red += !are_equal(a, 1, b, 1, FRAMES) || !are_equal(a, 2, b, 2, FRAMES);
        seen += !are_equal(a, 0, b, 0, FRAMES);
        drawn++;
    }
    tap_check(blue == 0,
              "other blue changes neither red nor green, %d settings", drawn);
    tap_check(red == 0, "other red changes neither green nor blue");
    tap_check(seen == 2 * drawn, "and is seen where it belongs");
}

/// Cuts ///

enum pass { STORE, RESOLVE, SHOW };

struct job {
    struct passes *passes;
    const struct brume_radiance *in; /* of the lattice */
    uint8_t *dst;
    size_t stride;
};

/* In work memory that is not a byte too large, with guards. */
static bool show_tile(const struct job *j, unsigned x, unsigned y, unsigned w,
                      unsigned h)
{
    const struct passes *p = j->passes;
    size_t size = brume_work_bytes(&p->frame, w);
    uint8_t *work = allocate(size + 2 * GUARD);
    memset(work, MARK, size + 2 * GUARD);
    bool good = brume_show_rect(&p->frame, p->state, x, y, w, h,
                                BRUME_RGB161616, j->dst + y * j->stride + 6 * x,
                                j->stride, work + GUARD, size) == BRUME_OK;
    for (int i = 0; i < GUARD; i++)
        good =
            good && work[i] == MARK && work[GUARD + size + (size_t)i] == MARK;
    free(work);
    return good;
}

static bool do_tile(const struct job *j, enum pass pass, unsigned x, unsigned y,
                    unsigned w, unsigned h)
{
    const struct passes *p = j->passes;
    unsigned across = p->frame.lattice[0];
    if (pass == STORE)
        return brume_store_rect(&p->frame, p->state, x, y, w, h,
                                j->in + y * across + x, across) == BRUME_OK;
    if (pass == RESOLVE)
        return brume_resolve_rect(&p->frame, p->state, x, y, w, h) == BRUME_OK;
    return show_tile(j, x, y, w, h);
}

/* The last tile first. */
static bool do_pass(const struct job *j, enum pass pass, const uint16_t area[2],
                    const unsigned tile[2])
{
    bool good = true;
    for (unsigned y = area[1]; y > 0;) {
        unsigned h = (y - 1) % tile[1] + 1;
        y -= h;
        for (unsigned x = area[0]; x > 0;) {
            unsigned w = (x - 1) % tile[0] + 1;
            x -= w;
            good = do_tile(j, pass, x, y, w, h) && good;
        }
    }
    return good;
}

/* A guarded copy of a state. */
static struct brume_state *guarded(const struct passes *p, uint8_t **memory)
{
    *memory = allocate(p->size + 2 * GUARD);
    memset(*memory, MARK, p->size + 2 * GUARD);
    memcpy(*memory + GUARD, p->state, p->size);
    return (struct brume_state *)(void *)(*memory + GUARD);
}

static bool guards_hold(const uint8_t *memory, size_t size)
{
    for (size_t i = 0; i < GUARD; i++)
        if (memory[i] != MARK || memory[GUARD + size + i] != MARK)
            return false;
    return true;
}

/* A frame in tiles, on a copy of the state of the frame before, into rows with
 * gaps. Returns what is wrong; the state goes on in *copy. */
static int cut_wrong(struct passes *p, const struct brume_radiance *in,
                     const unsigned tile[2], picture whole)
{
    enum { STRIDE = 6 * W + 10, SIZE = STRIDE * H };
    static uint8_t dst[SIZE + 2 * GUARD];
    const uint16_t image[2] = {W, H};
    uint8_t *memory;
    struct passes copy = *p;
    struct job job = {&copy, in, dst + GUARD, STRIDE};
    int wrong = 0;
    copy.state = guarded(p, &memory);
    memset(dst, MARK, sizeof dst);
    wrong += brume_begin_state(copy.state, &copy.frame) != BRUME_OK;
    wrong += !do_pass(&job, STORE, copy.frame.lattice, tile);
    if (copy.frame.temporal == BRUME_TAA)
        wrong += !do_pass(&job, RESOLVE, copy.frame.grid, tile);
    wrong += !do_pass(&job, SHOW, image, tile);
    for (int y = 0; y < H; y++) {
        const uint8_t *row = dst + GUARD + y * STRIDE;
        wrong += memcmp(row, whole[y * W], 6 * W) != 0;
        for (int i = 6 * W; i < STRIDE; i++)
            wrong += row[i] != MARK;
    }
    wrong += !guards_hold(dst, SIZE) || !guards_hold(memory, p->size);
    free(memory);
    return wrong;
}

static void test_cuts(void)
{
    enum { CUTS = 4 };
    static const unsigned k_tile[CUTS][2] = {{W, H}, {W, 1}, {7, 5}, {1, 1}};
    static const char *const k_name[CUTS] = {"whole", "rows", "tiles of 7x5",
                                             "single rays and pixels"};
    static struct brume_radiance in[PIXELS];
    static picture whole;
    int wrong[CUTS] = {0};
    for (int i = 0; i < SETTINGS; i++) {
        struct setting t = setting_of(i);
        struct passes p = {0};
        for (uint32_t f = 0; f < FRAMES; f++) {
            make_rays(in, f, 1);
            struct passes before = {0};
            if (f > 0) {
                before = p;
                before.state = allocate(p.size);
                memcpy(before.state, p.state, p.size);
            }
            begin(&p, &t, f, &k_coloured);
            before.frame = p.frame;
            passes_store(&p, in);
            passes_show(&p, BRUME_RGB161616, whole);
            for (int c = 0; f > 0 && c < CUTS; c++)
                wrong[c] += cut_wrong(&before, in, k_tile[c], whole) != 0;
            free(before.state);
        }
        passes_free(&p);
    }
    for (int c = 0; c < CUTS; c++)
        tap_check(wrong[c] == 0,
                  "%s, on a copy of the state: the same pixels, and no byte "
                  "beside its memory",
                  k_name[c]);
}

/// Marched rays ///

/* The last frame of a sequence that is marched in this light; without a state
 * where none is needed, if so wished. */
static void march(const struct setting *t, const struct brume_lighting *light,
                  bool state, picture out)
{
    struct passes p = {0};
    for (uint32_t f = 0; f < 3; f++) {
        struct brume_scene s = scene_of(t, f);
        s.lighting = light;
        s.step = 0x40000;
        s.light_samples = 2;
        passes_begin(&p, &s_volume, &s);
        passes_trace(&p);
        passes_show(&p, BRUME_RGB161616, out);
    }
    if (!state && brume_show_rect(&p.frame, NULL, 0, 0, W, H, BRUME_RGB161616,
                                  out, 6 * W, p.work, p.work_size) != BRUME_OK)
        abort();
    passes_free(&p);
}

/* Each channel of coloured light is that of a white sun of its strength. */
static void test_marched(void)
{
    static picture colour[1], white[1];
    int wrong = 0, differ = 0, grey = 0;
    for (int i = 0; i < SETTINGS; i += 7) {
        struct setting t = setting_of(i);
        bool alone = t.temporal == BRUME_TEMPORAL_NONE && t.update == 0;
        if (t.temporal == BRUME_TAA && t.clamp == BRUME_CLAMP_VARIANCE)
            continue;
        march(&t, &k_coloured, true, colour[0]);
        /* A quarter by turns is but four rays, all beside the volume. */
        grey += t.update != BRUME_BAYER4 && are_equal(colour, 0, colour, 1, 1);
        for (int c = 0; c < 3; c++) {
            uint32_t sun = k_coloured.sun_colour[c];
            struct brume_lighting one = {.sun_colour = {sun, sun, sun}};
            march(&t, &one, true, white[0]);
            for (int k = 0; k < PIXELS; k++)
                wrong += colour[0][k][c] != white[0][k][c];
        }
        march(&t, &k_coloured, !alone, white[0]);
        differ += memcmp(colour[0], white[0], sizeof colour) != 0;
    }
    tap_check(wrong == 0, "marched: channels are those of white suns");
    tap_check(grey == 0, "and are not alike");
    tap_check(differ == 0, "marched while shown: the same pixels");
}

/// Few bits ///

/* Rows of less than a byte to the pixel in pieces of 8 pixels and more. */
static int bits_wrong(const struct passes *p, int format)
{
    enum { ROW = (W + 1) / 2 };
    static uint8_t whole[ROW * H], cut[ROW * H];
    const size_t row = brume_row_bytes(format, W);
    int wrong = 0;
    memset(cut, MARK, sizeof cut);
    wrong += brume_show_rect(&p->frame, p->state, 0, 0, W, H, format, whole,
                             row, p->work, p->work_size) != BRUME_OK;
    for (unsigned x = 0; x < W; x += x == 0 ? 16 : 8)
        for (unsigned y = 0; y < H; y += 5) {
            unsigned w = x == 0 ? 16 : W - x, h = H - y < 5 ? H - y : 5;
            wrong += brume_show_rect(&p->frame, p->state, x, y, w, h, format,
                                     cut + y * row + brume_row_bytes(format, x),
                                     row, p->work, p->work_size) != BRUME_OK;
        }
    wrong += brume_show_rect(&p->frame, p->state, 4, 0, 8, 1, format, cut, row,
                             p->work, p->work_size) != BRUME_ERR_RECT;
    return wrong + (memcmp(whole, cut, row * H) != 0);
}

static void test_bits(void)
{
    static struct brume_radiance in[PIXELS];
    int wrong = 0;
    make_rays(in, 0, 1);
    for (int i = 0; i < SETTINGS; i++) {
        struct setting t = setting_of(i);
        struct passes p = {0};
        begin(&p, &t, 0, &k_coloured);
        passes_store(&p, in);
        for (int format = BRUME_L4; format <= BRUME_L1; format++)
            wrong += bits_wrong(&p, format);
        passes_free(&p);
    }
    tap_check(wrong == 0, "4, 2 and 1 bit: the same pixels in pieces, which "
                          "begin at multiples of 8");
}

/// Bright light ///

/* A scene that keeps an eighth of light. */
static struct brume_scene bright_scene(int temporal, int bits, double alpha)
{
    struct setting t = {temporal, 0, 0, bits, 0, 0, 0, 0};
    struct brume_scene s = scene_of(&t, 0);
    s.lighting = &k_coloured;
    s.output = BRUME_FILMIC;
    s.alpha = (uint32_t)(alpha * 65536);
    return s;
}

/* Both layers. */
static void history_of(const struct passes *p,
                       struct brume_sample out[2][PIXELS])
{
    for (uint32_t y = 0; y < H; y++) {
        brume_history_row(&p->frame, p->state, 0, y, W, out[0] + y * W);
        brume_colours_row(&p->frame, p->state, 0, y, W, out[1] + y * W);
    }
}

/* Light, kept and given back. */
static uint32_t kept(uint32_t light, uint32_t log2)
{
    return light_of_sample(sample_of_light(light, log2), log2);
}

static void test_bright(void)
{
    /* Code 65535 stands for 65536 eighths of 2^-13: from here on light is 8. */
    const uint32_t last = 65535u * 8u - 4u;
    static struct brume_radiance in[PIXELS];
    static struct brume_sample got[2][PIXELS];
    struct passes p = {0};
    struct brume_scene s = bright_scene(BRUME_TEMPORAL_NONE, 16, 1);
    uint32_t worst = 0, wrong = 0, dim = 0;
    passes_begin(&p, &s_volume, &s);
    tap_check(p.frame.lit.light_log2 == 3, "a filmic scene keeps light / 8");
    for (uint32_t v = 0; v < last; v++) {
        uint32_t loss = kept(v, 3) > v ? kept(v, 3) - v : v - kept(v, 3);
        worst = loss > worst ? loss : worst;
    }
    for (uint32_t v = last; v < last + 0x10000u; v++)
        dim += kept(v, 3) != BRUME_MAX_LIGHT;
    for (uint32_t v = 0xffff0000u; v != 0; v++)
        dim += kept(v, 3) != BRUME_MAX_LIGHT || kept(v, 0) != 0x10000u;
    tap_check(worst == 4, "light up to 8 to 1/2 of 2^-13");
    tap_check(dim == 0, "8, and all that is more, is 8");
    for (uint32_t i = 0; i < PIXELS; i++) {
        in[i].light = hash(i) % last;
        in[i].green = hash(~i) % last;
        in[i].blue = hash(i * 3u) % last;
        in[i].transmittance = hash(i * 7u) % 65537u;
    }
    passes_store(&p, in);
    history_of(&p, got);
    for (int i = 0; i < PIXELS; i++)
        wrong += light_of_sample(got[0][i].light, 3) != kept(in[i].light, 3) ||
                 light_of_sample(got[1][i].light, 3) != kept(in[i].green, 3) ||
                 light_of_sample(got[1][i].transmittance, 3) !=
                     kept(in[i].blue, 3) ||
                 got[0][i].transmittance != sample_of(in[i].transmittance);
    tap_check(wrong == 0, "so are stored rays, in all channels");
    passes_free(&p);
    s.output = BRUME_LINEAR;
    passes_begin(&p, &s_volume, &s);
    wrong = 0;
    for (uint32_t v = 0; v < 0x20000u; v++)
        wrong += v != 65535u && kept(v, 0) != (v < 0x10000u ? v : 0x10000u);
    tap_check(p.frame.lit.light_log2 == 0 && wrong == 0,
              "in other scenes light is kept as it is, up to 1");
    passes_free(&p);
}

/* The mean error of 3072 frames of noise around constant means, in 1/255 of
 * the range, of the worst channel; and of the worst ray. */
static void ema_error(int bits, double alpha, double error[2])
{
    enum { SETTLE = 1024, LAST = 3072 };
    static struct brume_radiance in[PIXELS];
    static struct brume_sample got[2][PIXELS];
    static double wanted[PIXELS][3], sum[PIXELS][3];
    struct brume_scene s = bright_scene(BRUME_EMA, bits, alpha);
    struct passes p = {0};
    double a = s.alpha / 65536.0, all[3] = {0, 0, 0};
    memset(sum, 0, sizeof sum);
    for (s.frame = 0; s.frame < SETTLE + LAST; s.frame++) {
        for (uint32_t i = 0; i < PIXELS; i++) {
            uint32_t v[3];
            for (uint32_t c = 0; c < 3; c++) {
                uint32_t mean = 4096u + hash(i * 3u + c) % 57000u;
                v[c] = mean - 4000u +
                       hash(s.frame * PIXELS * 3u + i * 3u + c) % 8001u;
                wanted[i][c] = s.frame == 0
                                   ? v[c]
                                   : wanted[i][c] + a * (v[c] - wanted[i][c]);
            }
            in[i].light = v[0] * 8u;
            in[i].green = v[1] * 8u;
            in[i].blue = v[2] * 8u;
        }
        passes_begin(&p, &s_volume, &s);
        passes_store(&p, in);
        if (s.frame < SETTLE)
            continue;
        history_of(&p, got);
        for (int i = 0; i < PIXELS; i++) {
            sum[i][0] += got[0][i].light - wanted[i][0];
            sum[i][1] += got[1][i].light - wanted[i][1];
            sum[i][2] += got[1][i].transmittance - wanted[i][2];
        }
    }
    error[0] = error[1] = 0;
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3; c++) {
            all[c] += sum[i][c] / LAST / 257 / PIXELS;
            error[1] = fmax(error[1], fabs(sum[i][c] / LAST / 257));
        }
    for (int c = 0; c < 3; c++)
        error[0] = fmax(error[0], fabs(all[c]));
    passes_free(&p);
}

static void test_ema(void)
{
    static const double k_alpha[] = {1 / 64.0, 0.1, 0.5};
    for (int a = 0; a < 3; a++) {
        double e16[2], e8[2];
        ema_error(16, k_alpha[a], e16);
        ema_error(8, k_alpha[a], e8);
        tap_check(e16[0] < 0.05 && e16[1] < 0.05,
                  "ema of bright colours, 16 bits, alpha %.4f: worst channel's "
                  "mean %.5f, worst ray's %.5f",
                  k_alpha[a], e16[0], e16[1]);
        tap_check(e8[0] < 0.05, "8 bits: %.5f (worst ray's %.5f)", e8[0],
                  e8[1]);
    }
}

/// Changes ///

/* Two frames in one light, then one in another, in the same memory: the same
 * as in a fresh one? */
static bool is_fresh(const struct setting *t,
                     const struct brume_lighting *before, int output_before,
                     const struct brume_lighting *after, int output)
{
    static struct brume_radiance in[PIXELS];
    static picture a, b;
    struct passes p = {0}, q = {0};
    struct brume_scene s = scene_of(t, 0);
    s.lighting = &k_coloured; /* room for all */
    passes_begin(&p, &s_volume, &s);
    if (brume_state_init(p.state, p.size) != BRUME_OK)
        abort();
    for (s.frame = 0; s.frame < 3; s.frame++) {
        make_rays(in, s.frame, 1);
        s.lighting = s.frame < 2 ? before : after;
        s.output = (uint8_t)(s.frame < 2 ? output_before : output);
        passes_begin(&p, &s_volume, &s);
        passes_store(&p, in);
        passes_show(&p, BRUME_RGB161616, a);
    }
    s.frame = 2;
    passes_begin(&q, &s_volume, &s);
    passes_store(&q, in);
    passes_show(&q, BRUME_RGB161616, b);
    passes_free(&p);
    passes_free(&q);
    return memcmp(a, b, sizeof a) == 0;
}

static void test_changes(void)
{
    int colour = 0, output = 0, none = 0;
    for (int i = 0; i < SETTINGS; i++) {
        struct setting t = setting_of(i);
        if (t.temporal == BRUME_TEMPORAL_NONE)
            continue;
        colour += !is_fresh(&t, &k_white, BRUME_SRGB, &k_coloured, BRUME_SRGB);
        colour += !is_fresh(&t, &k_coloured, BRUME_SRGB, NULL, BRUME_SRGB);
        output +=
            !is_fresh(&t, &k_coloured, BRUME_SRGB, &k_coloured, BRUME_FILMIC);
        output += !is_fresh(&t, &k_white, BRUME_FILMIC, &k_white, BRUME_LINEAR);
        none += is_fresh(&t, &k_white, BRUME_SRGB, NULL, BRUME_LINEAR);
    }
    tap_check(colour == 0, "light that gets or loses its colour drops history");
    tap_check(output == 0, "so does light that is kept to another limit");
    tap_check(none == 0, "no other change of light does");
}

/// Sizes ///

static size_t macro_bytes(const struct brume_scene *s)
{
    uint32_t x = (s->width + (1u << s->resolution) - 1) >> s->resolution;
    uint32_t y = (s->height + (1u << s->resolution) - 1) >> s->resolution;
    uint32_t bits = s->history_bits, depth = brume_scene_has_depth(s);
    uint32_t lattice = s->update == BRUME_CHECKER  ? (x + 1) / 2 * y
                       : s->update == BRUME_BAYER4 ? (x + 3) / 4 * ((y + 3) / 4)
                                                   : x * y;
    switch (s->temporal) {
    case BRUME_EMA:
        return BRUME_STATE_BYTES(x * y, BRUME_EMA_BYTES_RGB(bits, depth), 0, 0);
    case BRUME_WINDOW:
        return BRUME_STATE_BYTES(
            x * y, BRUME_WINDOW_BYTES_RGB(bits, s->window, depth), 0, 0);
    case BRUME_TAA:
        return BRUME_STATE_BYTES(x * y, BRUME_TAA_BYTES_RGB(bits), lattice,
                                 BRUME_SAMPLE_BYTES_RGB);
    default: return BRUME_STATE_BYTES(0, 0, lattice, BRUME_SAMPLE_BYTES_RGB);
    }
}

static void test_sizes(void)
{
    static const uint32_t k_taps[] = {1, 7, 5, 13};
    int wrong = 0, white = 0, work = 0, refused = 0;
    for (int i = 0; i < SETTINGS; i++) {
        struct setting t = setting_of(i);
        struct brume_scene s = scene_of(&t, 0);
        struct passes p = {0};
        size_t grey = brume_state_bytes(&s);
        s.lighting = &k_white;
        white += brume_state_bytes(&s) != grey;
        s.lighting = &k_coloured;
        size_t exact = brume_state_bytes(&s), most = macro_bytes(&s);
        wrong += exact <= grey || most < exact || most > exact + 64;
        passes_begin(&p, &s_volume, &s);
        for (unsigned w = 1; w <= W; w++) {
            size_t n = brume_work_bytes(&p.frame, w);
            work += n > BRUME_WORK_BYTES_RGB(w, k_taps[t.filter]);
        }
        p.state->size = (uint32_t)exact - 1u;
        refused += brume_begin_state(p.state, &p.frame) == BRUME_ERR_STATE;
        passes_free(&p);
    }
    tap_check(white == 0, "white light takes no more state than none");
    tap_check(wrong == 0, "the macros are at most 64 bytes more than a state");
    tap_check(refused == SETTINGS, "a state one byte smaller is refused");
    tap_check(work == 0, "BRUME_WORK_BYTES_RGB is enough");
    tap_check(BRUME_EMA_BYTES_RGB(8, 0) == 4 &&
                  BRUME_EMA_BYTES_RGB(16, 1) == 10,
              "8-bit ema: 4 bytes per ray; 16 bits and depth: 10");
}

int main(void)
{
    static const struct density_cloud cloud = {40, 5};
    struct asset_spec spec =
        asset_spec_of(5, 5, 5, BRUME_U8, density_in_cloud, &cloud);
    size_t size;
    uint8_t *asset = asset_build(&spec, &size);
    if (brume_volume_open(&s_volume, asset, size, 0) != BRUME_OK)
        abort();
    test_grey();
    test_permutations();
    test_independence();
    test_cuts();
    test_marched();
    test_bits();
    test_bright();
    test_ema();
    test_changes();
    test_sizes();
    free(asset);
    return tap_done();
}
