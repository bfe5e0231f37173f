/* SPDX-License-Identifier: MIT */
/*
 * Animated PNG, chunk by chunk and back to pixels; Y4M against the definition
 * in double; and compressed bytes that do not depend on the threads.
 */
#include "tap.h"

#include "brume.h"
#include "deflate.h"
#include "movie.h"
#include "movie_codec.h"
#include "png_pack.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char err[256];
static uint32_t seed = 1;

static uint32_t random32(void)
{
    seed = seed * 1664525u + 1013904223u;
    return seed >> 8;
}

/// Pictures ///

static struct image new_image(int width, int height, int channels)
{
    struct image image;
    if (image_new_u8(&image, width, height, channels, err, sizeof err) != 0)
        abort();
    return image;
}

/* A gradient with noise: rows that filters and matches can work on. */
static void fill(struct image *image, uint32_t shift)
{
    size_t row = (size_t)image->width * (size_t)image->channels;
    for (size_t i = 0; i < image_samples(image); i++)
        image->u8[i] =
            (uint8_t)(i % row / 5 + i / row + shift + random32() % 3);
}

/* Other pixels in a rectangle, which may be empty. */
static void change(struct image *image)
{
    uint32_t w = (uint32_t)image->width, h = (uint32_t)image->height;
    uint32_t x = random32() % w, y = random32() % h;
    uint32_t x1 = x + random32() % (w - x + 1), n = (uint32_t)image->channels;
    uint32_t y1 = y + random32() % (h - y + 1);
    for (uint32_t j = y; j < y1; j++)
        for (uint32_t i = x * n; i < x1 * n; i++)
            image->u8[j * w * n + i] = (uint8_t)random32();
}

static bool is_same(const struct image *a, const struct image *b)
{
    return a->width == b->width && a->height == b->height &&
           a->channels == b->channels &&
           memcmp(a->u8, b->u8, image_samples(a)) == 0;
}

/// Bytes ///

struct bytes {
    uint8_t *data;
    size_t size;
};

static void append(struct bytes *to, struct image_file *from)
{
    to->data = realloc(to->data, to->size + from->size);
    if (to->data == NULL || from->data == NULL)
        abort();
    memcpy(to->data + to->size, from->data, from->size);
    to->size += from->size;
    free(from->data);
    from->data = NULL;
}

static uint32_t be32(const uint8_t *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 |
           p[3];
}

static uint32_t be16(const uint8_t *p)
{
    return (uint32_t)p[0] << 8 | p[1];
}

/// Animated PNG ///

#define FRAMES 9

static struct movie_format format_of(const struct image *image)
{
    struct movie_format f = {.kind = MOVIE_APNG,
                             .width = image->width,
                             .height = image->height,
                             .channels = image->channels,
                             .frames = FRAMES,
                             .rate = {30000, 1001}};
    return f;
}

static struct bytes encode(const struct image *frame, struct pool *pool)
{
    struct movie_format format = format_of(frame);
    struct apng apng = {0};
    struct image_file part = {NULL, 0};
    struct bytes all = {NULL, 0};
    bool good = apng_start(&format, &part) == 0;
    append(&all, &part);
    for (int i = 0; i < FRAMES; i++) {
        good = apng_frame(&apng, &format, pool, &frame[i], &part) == 0 && good;
        append(&all, &part);
    }
    good = apng_end(&part) == 0 && good;
    append(&all, &part);
    apng_free(&apng);
    if (!good)
        abort();
    return all;
}

/* What the walk has seen. */
struct walk {
    const struct image *want; /* all frames */
    struct image canvas;
    uint32_t sequence, frames;
    uint32_t box[4]; /* of the last fcTL: width, height, x, y */
    const char *bad; /* the first thing that is wrong */
};

static void expect(struct walk *w, bool good, const char *what)
{
    if (!good && w->bad == NULL)
        w->bad = what;
}

/* A stream as a picture of its own, for the PNG reader, onto the canvas. */
static void draw(struct walk *w, const uint8_t *stream, size_t size)
{
    struct image part;
    size_t n = (size_t)w->canvas.channels;
    uint8_t *file = malloc(size + 100), *p = file;
    if (file == NULL)
        abort();
    p = png_put_start(p, w->box[0], w->box[1], n);
    p = png_put_chunk(p, "IDAT", stream, size);
    p = png_put_chunk(p, "IEND", NULL, 0);
    bool good =
        image_png_decode(file, (size_t)(p - file), &part, err, sizeof err) == 0;
    expect(w, good, "a frame that the PNG reader refuses");
    for (uint32_t y = 0; good && y < w->box[1]; y++)
        memcpy(w->canvas.u8 +
                   ((w->box[3] + y) * (size_t)w->canvas.width + w->box[2]) * n,
               part.u8 + y * w->box[0] * n, w->box[0] * n);
    if (good)
        image_free(&part);
    free(file);
    expect(w, w->frames < FRAMES && is_same(&w->canvas, &w->want[w->frames]),
           "a frame with other pixels");
    w->frames++;
}

static void see_fctl(struct walk *w, const uint8_t *p, size_t size)
{
    uint32_t width = (uint32_t)w->canvas.width;
    uint32_t height = (uint32_t)w->canvas.height;
    expect(w, size == 26 && be32(p) == w->sequence++, "fcTL's number");
    for (int i = 0; i < 4; i++)
        w->box[i] = be32(p + 4 + 4 * i);
    expect(w,
           w->box[0] >= 1 && w->box[1] >= 1 && w->box[2] < width &&
               w->box[3] < height && w->box[0] <= width - w->box[2] &&
               w->box[1] <= height - w->box[3],
           "a frame that is not inside the picture");
    expect(w, w->frames > 0 || (w->box[0] == width && w->box[1] == height),
           "a first frame that is not the whole picture");
    expect(w, be16(p + 20) == 1001 && be16(p + 22) == 30000, "the delay");
    expect(w, p[24] == 0 && p[25] == 0, "how a frame is put");
}

static void see_chunk(struct walk *w, const uint8_t *type, const uint8_t *p,
                      size_t size, uint32_t number)
{
    if (memcmp(type, "IHDR", 4) == 0) {
        expect(w, number == 0, "IHDR's place");
    } else if (memcmp(type, "acTL", 4) == 0) {
        expect(w, number == 1 && be32(p) == FRAMES && be32(p + 4) == 0, "acTL");
    } else if (memcmp(type, "fcTL", 4) == 0) {
        see_fctl(w, p, size);
    } else if (memcmp(type, "IDAT", 4) == 0) {
        expect(w, w->frames == 0, "IDAT's place");
        draw(w, p, size);
    } else if (memcmp(type, "fdAT", 4) == 0) {
        expect(w, w->frames > 0 && be32(p) == w->sequence++, "fdAT's number");
        draw(w, p + 4, size - 4);
    } else {
        expect(w, memcmp(type, "IEND", 4) == 0, "a chunk of another name");
    }
}

/* Every chunk, with its length and checksum; every frame. */
static const char *walk(const struct bytes *all, const struct image *want)
{
    struct walk w = {.want = want};
    size_t at = 8;
    uint32_t number = 0;
    w.canvas = new_image(want->width, want->height, want->channels);
    for (; at + 12 <= all->size; number++) {
        const uint8_t *p = all->data + at;
        size_t size = be32(p);
        expect(&w, size <= all->size - at - 12, "a chunk's length");
        if (w.bad != NULL)
            break;
        expect(&w, deflate_crc32(0, p + 4, size + 4) == be32(p + 8 + size),
               "a chunk's checksum");
        see_chunk(&w, p + 4, p + 8, size, number);
        at += size + 12;
    }
    expect(&w, at == all->size, "bytes behind the chunks");
    expect(&w, w.frames == FRAMES, "the number of frames");
    image_free(&w.canvas);
    return w.bad;
}

static void test_apng_of(int width, int height, int channels)
{
    struct image frame[FRAMES], first;
    for (int i = 0; i < FRAMES; i++) {
        frame[i] = new_image(width, height, channels);
        fill(&frame[i], 0);
        if (i > 0)
            memcpy(frame[i].u8, frame[i - 1].u8, image_samples(&frame[i]));
        if (i != 4) /* 4 is as 3 */
            change(&frame[i]);
    }
    struct bytes one = encode(frame, NULL);
    const char *bad = walk(&one, frame);
    tap_check(bad == NULL,
              "apng %dx%d, %d channels: every frame comes back%s%s", width,
              height, channels, bad ? ", but for " : "", bad ? bad : "");
    bool good =
        image_png_decode(one.data, one.size, &first, err, sizeof err) == 0;
    tap_check(good && is_same(&first, &frame[0]),
              "apng %dx%d, %d channels: a PNG reader shows the first", width,
              height, channels);
    if (good)
        image_free(&first);
    struct pool *pool = pool_new(3);
    struct bytes three = encode(frame, pool);
    tap_check(one.size == three.size &&
                  memcmp(one.data, three.data, one.size) == 0,
              "apng %dx%d, %d channels: the same bytes by three threads", width,
              height, channels);
    pool_free(pool);
    free(one.data);
    free(three.data);
    for (int i = 0; i < FRAMES; i++)
        image_free(&frame[i]);
}

/// Y4M ///

/* ITU-R BT.601: Kr 0.299, Kb 0.114; 219 steps for Y', 224 for Cb and Cr. */
static double worst_of_all_colours(void)
{
    double worst = 0;
    for (uint32_t i = 0; i < 1u << 24; i++) {
        const uint8_t rgb[3] = {(uint8_t)(i >> 16), (uint8_t)(i >> 8),
                                (uint8_t)i};
        uint8_t got[3];
        double r = rgb[0] / 255.0, g = rgb[1] / 255.0, b = rgb[2] / 255.0;
        double y = 0.299 * r + 0.587 * g + 0.114 * b;
        const double want[3] = {16 + 219 * y, 128 + 224 * (b - y) / 1.772,
                                128 + 224 * (r - y) / 1.402};
        y4m_from_rgb(rgb, got);
        for (int c = 0; c < 3; c++)
            worst = fmax(worst, fabs(got[c] - want[c]));
    }
    return worst;
}

static bool is_colour(uint8_t r, uint8_t g, uint8_t b, uint8_t y, uint8_t cb,
                      uint8_t cr)
{
    const uint8_t rgb[3] = {r, g, b};
    uint8_t got[3];
    y4m_from_rgb(rgb, got);
    return got[0] == y && got[1] == cb && got[2] == cr;
}

static void test_y4m_colours(void)
{
    double worst = worst_of_all_colours();
    tap_check(worst <= 0.51, "y4m: all 2^24 colours to %.4f of a code", worst);
    tap_check(is_colour(0, 0, 0, 16, 128, 128) &&
                  is_colour(255, 255, 255, 235, 128, 128) &&
                  is_colour(255, 0, 0, 81, 90, 240) &&
                  is_colour(0, 255, 0, 145, 54, 34) &&
                  is_colour(0, 0, 255, 41, 240, 110),
              "y4m: the corners of the cube as BT.601 has them");
    bool grey = true;
    for (int i = 0; i < 256; i++) {
        const uint8_t rgb[3] = {(uint8_t)i, (uint8_t)i, (uint8_t)i};
        uint8_t got[3];
        y4m_from_rgb(rgb, got);
        grey = grey && got[1] == 128 && got[2] == 128;
    }
    tap_check(grey, "y4m: greys have no colour");
}

static void test_y4m_of(int width, int height, int channels)
{
    struct image image = new_image(width, height, channels);
    struct movie_format format = format_of(&image);
    struct image_file head, frame;
    char want[128];
    fill(&image, 3);
    struct pool *pool = pool_new(2);
    bool good =
        y4m_start(&format, &head) == 0 && y4m_frame(pool, &image, &frame) == 0;
    snprintf(want, sizeof want,
             "YUV4MPEG2 W%d H%d F30000:1001 Ip A1:1 C444 "
             "XCOLORRANGE=LIMITED\n",
             width, height);
    tap_check(good && head.size == strlen(want) &&
                  memcmp(head.data, want, head.size) == 0,
              "y4m %dx%d: the header", width, height);
    size_t pixels = (size_t)width * (size_t)height, wrong = 0;
    good = good && frame.size == 6 + 3 * pixels &&
           memcmp(frame.data, "FRAME\n", 6) == 0;
    for (size_t i = 0; good && i < pixels; i++) {
        const uint8_t *p = image.u8 + i * (size_t)channels;
        const uint8_t rgb[3] = {p[0], channels == 3 ? p[1] : p[0],
                                channels == 3 ? p[2] : p[0]};
        uint8_t ycc[3];
        y4m_from_rgb(rgb, ycc);
        for (size_t c = 0; c < 3; c++)
            wrong += frame.data[6 + c * pixels + i] != ycc[c];
    }
    tap_check(good && wrong == 0, "y4m %dx%d, %d channels: three planes", width,
              height, channels);
    pool_free(pool);
    free(head.data);
    free(frame.data);
    image_free(&image);
}

/// Threads ///

static void test_pieces(int width, int height, int channels)
{
    struct image image = new_image(width, height, channels), back;
    struct image_file one, many;
    bool good = true;
    fill(&image, 0);
    if (image_png_encode(&image, &one, err, sizeof err) != 0)
        abort();
    good = image_png_decode(one.data, one.size, &back, err, sizeof err) == 0 &&
           is_same(&image, &back);
    image_free(&back);
    tap_check(good, "png %dx%d, %d channels: there and back", width, height,
              channels);
    for (int threads = 2; threads < 6; threads += 3) {
        struct pool *pool = pool_new(threads);
        if (image_png_encode_with(pool, &image, &many, err, sizeof err) != 0)
            abort();
        good = good && many.size == one.size &&
               memcmp(many.data, one.data, one.size) == 0;
        free(many.data);
        pool_free(pool);
    }
    tap_check(good, "png %dx%d: the same bytes by 1, 2 and 5 threads", width,
              height);
    free(one.data);
    image_free(&image);
}

/// Checksums ///

static uint32_t crc_by_bits(const uint8_t *p, size_t size)
{
    uint32_t crc = 0xffffffffu;
    for (size_t i = 0; i < size; i++) {
        crc ^= p[i];
        for (int k = 0; k < 8; k++)
            crc = crc >> 1 ^ (0xedb88320u & (0u - (crc & 1u)));
    }
    return ~crc;
}

/* Tables and folding meet at multiples of 16 and 64 bytes. */
static void test_crc(void)
{
    static uint8_t data[70000];
    bool good = true;
    for (size_t i = 0; i < sizeof data; i++)
        data[i] = (uint8_t)random32();
    for (size_t size = 0; size < 400; size++)
        for (size_t from = 0; from < 4; from++)
            good = good && deflate_crc32(0, data + from, size) ==
                               crc_by_bits(data + from, size);
    tap_check(good, "crc: 0 to 399 bytes from any place in a word");
    uint32_t whole = crc_by_bits(data, sizeof data);
    good = deflate_crc32(0, data, sizeof data) == whole;
    for (size_t cut = 1; cut < sizeof data; cut += 997)
        good = good && deflate_crc32(deflate_crc32(0, data, cut), data + cut,
                                     sizeof data - cut) == whole;
    tap_check(good, "crc: 70000 bytes, whole and in two parts");
    tap_check(brume_asset_crc(data, sizeof data) ==
                  deflate_crc32(0, data + BRUME_OFF_FORMAT,
                                sizeof data - BRUME_OFF_FORMAT),
              "crc: the host's and the core's of an asset agree");
}

/// Files ///

static bool is_there(const char *path)
{
    struct stat st;
    return stat(path, &st) == 0;
}

/* Two of three frames: neither the film nor its temporary file is left. */
static void test_unfinished(enum movie_kind kind, const char *name)
{
    char dir[64], path[128], temporary[160];
    const char *tmp = getenv("TMPDIR");
    struct image image = new_image(8, 8, 3);
    struct movie_format format = format_of(&image);
    snprintf(dir, sizeof dir, "%.40s/brumeXXXXXX", tmp ? tmp : "/tmp");
    if (mkdtemp(dir) == NULL)
        abort();
    snprintf(path, sizeof path, "%s/%s", dir, name);
    snprintf(temporary, sizeof temporary, "%s.tmp%ld", path, (long)getpid());
    format.kind = kind;
    format.path = path;
    format.frames = 3;
    struct movie *movie = movie_open(&format, NULL, NULL, err, sizeof err);
    bool good = movie != NULL && is_there(temporary) && !is_there(path);
    for (uint32_t i = 0; good && i < 2; i++)
        good = movie_add(movie, &image, i, err, sizeof err) == 0;
    if (movie != NULL)
        movie_close(movie, err, sizeof err);
    tap_check(good && !is_there(path) && !is_there(temporary),
              "%s: nothing is left of a film without its end", name);
    image_free(&image);
    tap_check(rmdir(dir) == 0, "%s: and the folder is empty", name);
}

int main(void)
{
    test_apng_of(64, 48, 3);
    test_apng_of(37, 23, 1);
    test_apng_of(1, 1, 3);
    test_apng_of(400, 300, 3);
    test_y4m_colours();
    test_y4m_of(31, 17, 3);
    test_y4m_of(300, 200, 1);
    test_pieces(700, 500, 3);
    test_pieces(2000, 131, 1);
    test_crc();
    test_unfinished(MOVIE_APNG, "film.apng");
    test_unfinished(MOVIE_Y4M, "film.y4m");
    return tap_done();
}
