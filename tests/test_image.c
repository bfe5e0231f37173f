/* SPDX-License-Identifier: MIT */
/*
 * Deflate, the picture formats and `brume compare`. Checks that need netpbm
 * or pngcheck are skipped by name where those are not installed.
 */
#include "tap.h"

#include "../platform/host/compare.h"
#include "../platform/host/deflate.h"
#include "../platform/host/image.h"
#include "../platform/host/image_codec.h"
#include "../platform/host/metrics.h"

#include <dirent.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#define ERR_SIZE 400
#define PATH_SIZE 512

static char dir[PATH_SIZE / 2]; /* of this run, removed at the end */
static char err[ERR_SIZE];
static uint32_t seed = 1;

/// Helpers ///

static uint32_t next_random(void)
{
    seed ^= seed << 13;
    seed ^= seed >> 17;
    seed ^= seed << 5;
    return seed;
}

static void *must(void *p)
{
    if (!p) {
        perror("test_image");
        exit(1);
    }
    return p;
}

/* A copy in a block of its own, so that a sanitizer sees any overrun. */
static uint8_t *copy_of(const uint8_t *data, size_t size)
{
    uint8_t *copy = must(malloc(size ? size : 1));

    memcpy(copy, data, size);
    return copy;
}

/* dir/name, in one of four buffers used in turn. */
static const char *in_dir(const char *name)
{
    static char text[4][PATH_SIZE];
    static int turn;

    turn = (turn + 1) % 4;
    snprintf(text[turn], PATH_SIZE, "%s/%s", dir, name);
    return text[turn];
}

/* Run a shell command in the directory of this run. */
static int shell(const char *command)
{
    char text[2 * PATH_SIZE];

    snprintf(text, sizeof text, "cd '%s' && %s", dir, command);
    return system(text);
}

static int have_tool(const char *name)
{
    char text[PATH_SIZE];

    snprintf(text, sizeof text, "command -v %s >/dev/null 2>&1", name);
    return system(text) == 0;
}

static int files_in_dir(void)
{
    DIR *d = must(opendir(dir));
    int count = -2; /* . and .. */

    while (readdir(d))
        count++;
    closedir(d);
    return count;
}

static long file_size(const char *path)
{
    FILE *f = fopen(path, "rb");
    long size = -1;

    if (f && fseek(f, 0, SEEK_END) == 0)
        size = ftell(f);
    if (f)
        fclose(f);
    return size;
}

static void put_file(const char *path, const char *data, size_t size)
{
    FILE *f = must(fopen(path, "wb"));

    if (fwrite(data, 1, size, f) != size || fclose(f) != 0)
        must(NULL);
}

static void get_text(const char *path, char *text, size_t size)
{
    FILE *f = must(fopen(path, "rb"));

    text[fread(text, 1, size - 1, f)] = '\0';
    fclose(f);
}

static int same_image(const struct image *a, const struct image *b)
{
    size_t size = image_samples(a) * (a->u8 ? 1 : sizeof(float));

    return a->width == b->width && a->height == b->height &&
           a->channels == b->channels && !a->u8 == !b->u8 &&
           memcmp(a->u8 ? (void *)a->u8 : (void *)a->f32,
                  b->u8 ? (void *)b->u8 : (void *)b->f32, size) == 0;
}

enum kind { FLAT, GRADIENT, NOISE, CLOUD };

static double lattice(int x, int y)
{
    uint32_t h = (uint32_t)x * 374761393u + (uint32_t)y * 668265263u;

    h = (h ^ h >> 13) * 1274126177u;
    return (double)((h ^ h >> 16) & 0xFFFFu) / 65535;
}

static double smooth_noise(double x, double y)
{
    int i = (int)x, j = (int)y;
    double u = x - i, v = y - j;

    u *= u * (3 - 2 * u);
    v *= v * (3 - 2 * v);
    return (lattice(i, j) * (1 - u) + lattice(i + 1, j) * u) * (1 - v) +
           (lattice(i, j + 1) * (1 - u) + lattice(i + 1, j + 1) * u) * v;
}

/* A white cloud with jitter noise in it before a sky. */
static int cloud_sample(int x, int y, int height, int c)
{
    double f = 0, a = 0.5, s = 1.0 / 128;

    for (int octave = 0; octave < 5; octave++, a /= 2, s *= 2)
        f += a * smooth_noise(x * s, y * s);
    f = fmin(fmax((f - 0.4) * 3, 0), 1);
    return (int)((80 + c * 40 + y * 60.0 / height) * (1 - f) + f * 230 +
                 (f > 0 ? next_random() % 7 : 0));
}

static struct image make_image(enum kind kind, int w, int h, int channels)
{
    struct image image;
    uint8_t *p;

    if (image_new_u8(&image, w, h, channels, err, sizeof err))
        must(NULL);
    p = image.u8;
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++)
            for (int c = 0; c < channels; c++) {
                int v = kind == FLAT       ? 40 + 20 * c
                        : kind == GRADIENT ? x * 255 / w + c * y / 8
                        : kind == NOISE    ? (int)(next_random() >> 24)
                                           : cloud_sample(x, y, h, c);
                *p++ = (uint8_t)(v & 255);
            }
    return image;
}

/// Deflate ///

static const char text_words[] =
    "the light that leaves the cloud is the light that entered it, less "
    "what the droplets took, plus what they turned towards the eye; ";

static void fill_text(uint8_t *p, size_t size)
{
    size_t at = 0;

    for (size_t i = 0; i < size; i++, at++) {
        if (next_random() % 23 == 0)
            at = next_random();
        p[i] = (uint8_t)text_words[at % (sizeof text_words - 1)];
    }
}

static int round_trip(const uint8_t *data, size_t size, unsigned min_match)
{
    size_t packed_size;
    uint8_t *packed = must(deflate_zlib(data, size, min_match, &packed_size));
    uint8_t *exact = copy_of(packed, packed_size);
    uint8_t *out = must(malloc(size ? size : 1));
    int good = inflate_zlib(exact, packed_size, out, size) == 0 &&
               memcmp(out, data, size) == 0 &&
               packed_size <= size + size / 1024 + 64;

    free(packed);
    free(exact);
    free(out);
    return good;
}

static int both_trips(const uint8_t *data, size_t size)
{
    return round_trip(data, size, DEFLATE_PLAIN) &&
           round_trip(data, size, DEFLATE_FILTERED);
}

/* Byte k turns up as often as the k-th Fibonacci number, the worst case for
 * the length of a Huffman code: without a limit it would pass 15 bits. Every
 * other byte is noise of a few values, which keeps matches short. */
static void fill_fibonacci(uint8_t *p, size_t size)
{
    for (size_t i = 0; i < size; i++) {
        uint32_t r = next_random() % 28656, a = 1, b = 1, k = 0;
        for (; r >= a; k++) {
            r -= a;
            b += a;
            a = b - a;
        }
        p[i] = (uint8_t)(i % 2 ? k : 64 + next_random() % 64);
    }
}

static void test_round_trips(void)
{
    const size_t mega = 1u << 20;
    uint8_t *p = must(calloc(mega, 1));
    int good = 1;

    tap_check(both_trips(p, 0), "deflate round trip of nothing");
    tap_check(both_trips(p, 1), "deflate round trip of 1 byte");
    tap_check(both_trips(p, mega), "deflate round trip of 1 MiB of zeros");
    for (size_t n = 0; n <= 600; n++) {
        good = good && both_trips(p, n);
        fill_text(p, n);
        good = good && both_trips(p, n);
        for (size_t i = 0; i < n; i++)
            p[i] = (uint8_t)(next_random() & 255u);
        good = good && both_trips(p, n);
        memset(p, 0, n);
    }
    tap_check(good, "deflate round trips of 0 to 600 zeros, text, noise");
    fill_text(p, mega);
    tap_check(both_trips(p, mega), "deflate round trip of 1 MiB of text");
    for (size_t i = 0; i < mega; i++)
        p[i] = (uint8_t)(next_random() & 255u);
    tap_check(both_trips(p, mega), "deflate round trip of 1 MiB of noise");
    for (size_t i = 0, run = 1, v = 0; i < mega; i++)
        if (p[i] = (uint8_t)(v & 255u), --run == 0) {
            run = 1 + next_random() % 600;
            v = next_random();
        }
    tap_check(both_trips(p, mega), "deflate round trip of runs");
    for (size_t i = 32768; i < mega; i++)
        p[i] = p[i - 32768];
    tap_check(both_trips(p, mega), "deflate round trip at the window's end");
    for (size_t i = 0; i < mega; i++) {
        uint32_t r = next_random() | 1u << 24;
        for (p[i] = 0; (r & 1u) == 0; r >>= 1)
            p[i]++;
    }
    tap_check(both_trips(p, mega), "deflate round trip of skewed bytes");
    fill_fibonacci(p, mega);
    tap_check(both_trips(p, mega), "deflate round trip of Fibonacci counts");
    free(p);
}

/* Streams made by zlib, and what they hold. */
static void test_vectors(void)
{
    static const uint8_t fixed[] = {
        0x78, 0x9C, 0xCB, 0x48, 0xCD, 0xC9, 0xC9,
        0x07, 0x00, 0x06, 0x2C, 0x02, 0x15,
    };
    static const uint8_t stored[] = {
        0x78, 0x01, 0x01, 0x05, 0x00, 0xFA, 0xFF, 0x62,
        0x72, 0x75, 0x6D, 0x65, 0x06, 0x55, 0x02, 0x1C,
    };
    static const uint8_t dynamic[] = {
        0x78, 0xDA, 0xC5, 0x8D, 0xC9, 0x0D, 0x80, 0x40, 0x10, 0xC3, 0x72,
        0x4C, 0x26, 0xFD, 0x77, 0xCC, 0x22, 0x21, 0x28, 0x01, 0x47, 0x96,
        0x9F, 0x01, 0x6E, 0x48, 0xC9, 0x9E, 0x6C, 0x41, 0x9D, 0x16, 0x72,
        0x16, 0x9A, 0xC7, 0x54, 0x53, 0x4E, 0x15, 0x78, 0x4F, 0xBD, 0x0A,
        0x07, 0xEF, 0x18, 0xAD, 0x3B, 0x5C, 0x23, 0x3A, 0xED, 0xA8, 0x11,
        0x76, 0x1E, 0x63, 0xA1, 0x19, 0x8B, 0xE8, 0x9E, 0x5A, 0x22, 0xF1,
        0xF1, 0xDF, 0xFF, 0x05, 0x81, 0x0F, 0x03, 0x01,
    };
    static const uint8_t empty[] = {
        0x78, 0xDA, 0x03, 0x00, 0x00, 0x00, 0x00, 0x01,
    };
    uint8_t out[256];
    int good;

    tap_check(deflate_crc32(0, "123456789", 9) == 0xCBF43926u, "CRC-32");
    tap_check(deflate_crc32(deflate_crc32(0, "12345", 5), "6789", 4) ==
                  0xCBF43926u,
              "CRC-32 in two parts");
    tap_check(deflate_adler32(1, "Wikipedia", 9) == 0x11E60398u, "Adler-32");
    tap_check(inflate_zlib(fixed, sizeof fixed, out, 5) == 0 &&
                  memcmp(out, "hello", 5) == 0,
              "fixed block of zlib");
    tap_check(inflate_zlib(stored, sizeof stored, out, 5) == 0 &&
                  memcmp(out, "brume", 5) == 0,
              "stored block of zlib");
    tap_check(inflate_zlib(empty, sizeof empty, NULL, 0) == 0,
              "empty stream of zlib");
    good = inflate_zlib(dynamic, sizeof dynamic, out, 256) == 0;
    for (unsigned i = 0; i < 256; i++)
        good = good && out[i] == (i * i >> 5 & 7u);
    tap_check(good, "dynamic block of zlib");
    tap_check(
        inflate_zlib(fixed, sizeof fixed, out, 4) == INFLATE_ERR_TOO_LONG &&
            inflate_zlib(fixed, sizeof fixed, out, 6) == INFLATE_ERR_TOO_SHORT,
        "wrong expected size");
    tap_check(inflate_zlib((const uint8_t *)"\x78\x9D", 2, out, 1) ==
                  INFLATE_ERR_HEADER,
              "bad zlib header");
}

/* One hostile stream: inflate must stay inside dst, whatever it returns. */
static int inflate_inside(const uint8_t *data, size_t size, size_t dst_size,
                          int *result)
{
    uint8_t *exact = copy_of(data, size), *out = must(malloc(dst_size + 8));
    int good = 1;

    memset(out + dst_size, 0xA5, 8);
    *result = inflate_zlib(exact, size, out, dst_size);
    for (size_t i = 0; i < 8; i++)
        good = good && out[dst_size + i] == 0xA5;
    free(exact);
    free(out);
    return good && *result <= 0 && *result >= INFLATE_ERR_CHECKSUM;
}

static void test_hostile_streams(void)
{
    enum { SIZE = 3000, MUTATIONS = 20000 };
    uint8_t data[SIZE], *packed;
    size_t size;
    int good = 1, result, passed = 0;

    fill_text(data, SIZE);
    packed = must(deflate_zlib(data, SIZE, DEFLATE_PLAIN, &size));
    for (size_t n = 0; n < size; n++)
        good = good && inflate_inside(packed, n, SIZE, &result) && result != 0;
    tap_check(good, "a stream cut at each of %lu places is refused",
              (unsigned long)size);
    good = 1;
    for (int i = 0; i < MUTATIONS; i++) {
        uint8_t *bad = copy_of(packed, size);
        for (uint32_t n = 1 + next_random() % 4; n > 0; n--)
            bad[next_random() % size] ^= (uint8_t)(1u << next_random() % 8);
        good = good && inflate_inside(bad, size, SIZE, &result);
        passed += result == 0;
        free(bad);
    }
    free(packed);
    tap_check(good, "%d damaged streams stay in bounds", MUTATIONS);
    /* Two equal flips cancel out; anything else should be noticed. */
    tap_check(passed < MUTATIONS / 100, "damaged streams are noticed");
    good = 1;
    for (int i = 0; i < MUTATIONS; i++) {
        uint8_t junk[64] = {0x78, 0x9C};
        for (size_t k = 2; k < sizeof junk; k++)
            junk[k] = (uint8_t)(next_random() & 255u);
        good = good && inflate_inside(junk, sizeof junk, SIZE, &result);
    }
    tap_check(good, "%d streams of noise stay in bounds", MUTATIONS);
}

/// PNG made by hand ///

static uint8_t *put_be32(uint8_t *p, uint32_t v)
{
    for (int i = 0; i < 4; i++)
        p[i] = (uint8_t)(v >> (24 - 8 * i) & 255u);
    return p + 4;
}

static void put_chunk(struct image_file *f, const char *type,
                      const uint8_t *data, size_t size)
{
    uint8_t *p;

    f->data = must(realloc(f->data, f->size + size + 12));
    p = put_be32(f->data + f->size, (uint32_t)size);
    memcpy(p, type, 4);
    memcpy(p + 4, data, size);
    put_be32(p + 4 + size, deflate_crc32(0, p, size + 4));
    f->size += size + 12;
}

static void put_signature(struct image_file *f)
{
    f->data = must(malloc(8));
    f->size = 8;
    memcpy(f->data, "\x89PNG\r\n\x1A\n", 8);
}

/* A PNG of the given scan lines, with a grey palette of `colours` entries
 * (i, i, 255 - i) and an ancillary and an `extra` chunk. */
static struct image_file hand_png(uint32_t w, uint32_t h, unsigned depth,
                                  unsigned colour, unsigned colours,
                                  const uint8_t *raw, size_t raw_size,
                                  const char *extra)
{
    struct image_file f;
    uint8_t ihdr[13] = {0}, plte[768], *idat;
    size_t idat_size;

    put_signature(&f);
    put_be32(ihdr, w);
    put_be32(ihdr + 4, h);
    ihdr[8] = (uint8_t)depth;
    ihdr[9] = (uint8_t)colour;
    put_chunk(&f, "IHDR", ihdr, 13);
    for (unsigned i = 0; i < colours; i++) {
        plte[3 * i] = plte[3 * i + 1] = (uint8_t)i;
        plte[3 * i + 2] = (uint8_t)(255 - i);
    }
    if (colours > 0)
        put_chunk(&f, "PLTE", plte, 3 * (size_t)colours);
    put_chunk(&f, "tEXt", (const uint8_t *)"k\0v", 3);
    put_chunk(&f, "tRNS", (const uint8_t *)"\0\1", 2);
    if (extra)
        put_chunk(&f, extra, (const uint8_t *)"x", 1);
    idat = must(deflate_zlib(raw, raw_size, DEFLATE_PLAIN, &idat_size));
    put_chunk(&f, "IDAT", idat, idat_size / 2); /* in two parts */
    put_chunk(&f, "IDAT", idat + idat_size / 2, idat_size - idat_size / 2);
    free(idat);
    put_chunk(&f, "IEND", ihdr, 0);
    return f;
}

/* Sample i of a packed row as the format defines it: high bits first. */
static unsigned packed_sample(const uint8_t *row, size_t i, unsigned depth)
{
    unsigned v = 0;

    for (unsigned k = 0; k < depth; k++) {
        size_t bit = i * depth + k;
        v = v << 1 | ((unsigned)row[bit / 8] >> (7 - bit % 8) & 1u);
    }
    return v;
}

static int hand_png_reads(unsigned depth, unsigned colour, unsigned samples)
{
    enum { W = 11, H = 5 };
    size_t row = (W * samples * depth + 7) / 8;
    uint8_t raw[H * (1 + W * 4)];
    struct image_file f;
    struct image image;
    int good, ch = colour == 0 || colour == 4 ? 1 : 3;

    for (size_t i = 0; i < H * (row + 1); i++)
        raw[i] = i % (row + 1) ? (uint8_t)(next_random() & 255u) : 0;
    f = hand_png(W, H, depth, colour, colour == 3 ? 1u << depth : 0, raw,
                 H * (row + 1), NULL);
    good = image_png_decode(f.data, f.size, &image, err, sizeof err) == 0 &&
           image.width == W && image.height == H && image.channels == ch;
    for (size_t i = 0; good && i < W * H; i++)
        for (int c = 0; c < ch; c++) {
            const uint8_t *line = raw + i / W * (row + 1) + 1;
            size_t at = i % W * samples + (colour == 3 ? 0 : (size_t)c);
            unsigned v = packed_sample(line, at, depth);
            if (colour == 3)
                v = c == 2 ? 255 - v : v;
            else
                v = v * 255 / ((1u << depth) - 1);
            good = good && image.u8[i * (size_t)ch + (size_t)c] == v;
        }
    free(f.data);
    image_free(&image);
    return good;
}

static const struct {
    unsigned depth, colour, samples;
} png_types[] = {
    {1, 0, 1}, {2, 0, 1}, {4, 0, 1}, {8, 0, 1}, {8, 2, 3}, {1, 3, 1},
    {2, 3, 1}, {4, 3, 1}, {8, 3, 1}, {8, 4, 2}, {8, 6, 4},
};
enum { PNG_TYPES = sizeof png_types / sizeof *png_types };

static void test_hand_png(void)
{
    for (int i = 0; i < PNG_TYPES; i++)
        tap_check(hand_png_reads(png_types[i].depth, png_types[i].colour,
                                 png_types[i].samples),
                  "PNG colour type %u, %u bits", png_types[i].colour,
                  png_types[i].depth);
}

/* Bytes of scan lines, interlaced or not. */
static size_t raw_bytes(unsigned w, unsigned h, unsigned pixel_bits,
                        int interlaced)
{
    static const unsigned pass[7][4] = {
        {0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
        {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2},
    };
    size_t sum = 0;

    if (!interlaced)
        return h * (1 + (size_t)(w * pixel_bits + 7) / 8);
    for (int i = 0; i < 7; i++) {
        unsigned n = 0, rows = 0;
        for (unsigned x = pass[i][0]; x < w; x += pass[i][2])
            n++;
        for (unsigned y = pass[i][1]; y < h; y += pass[i][3])
            rows++;
        sum += n ? rows * (1 + (size_t)(n * pixel_bits + 7) / 8) : 0;
    }
    return sum;
}

static void repair_crcs(uint8_t *p, size_t size);

/* Scan lines of bytes 0 to 4 are good in every type: any filter, any size,
 * any interlacing; the palettes are full, so no colour is outside. */
static void test_random_rows(void)
{
    uint8_t raw[4096];
    int good = 1;

    for (int i = 0; i < 4000; i++) {
        int t = i % PNG_TYPES, interlaced = i / PNG_TYPES % 2;
        unsigned w = 1 + next_random() % 21, h = 1 + next_random() % 21;
        unsigned depth = png_types[t].depth, colour = png_types[t].colour;
        size_t size = raw_bytes(w, h, depth * png_types[t].samples, interlaced);
        struct image_file f;
        struct image image;
        for (size_t k = 0; k < size; k++)
            raw[k] = (uint8_t)(next_random() % 5);
        f = hand_png(w, h, depth, colour, colour == 3 ? 1u << depth : 0, raw,
                     size, NULL);
        f.data[28] = (uint8_t)interlaced;
        repair_crcs(f.data, f.size);
        good = good &&
               image_png_decode(f.data, f.size, &image, err, sizeof err) == 0;
        image_free(&image);
        free(f.data);
    }
    tap_check(good, "PNGs of any type, size and interlacing");
}

static int refuses(struct image_file f, const char *words)
{
    struct image image;
    int bad = image_png_decode(f.data, f.size, &image, err, sizeof err);

    free(f.data);
    image_free(&image);
    return bad && strstr(err, words) && !strchr(err, '\n');
}

static void test_bad_png(void)
{
    uint8_t raw[12] = {0, 0, 9}, filter[12] = {5};
    struct image_file f;

    tap_check(refuses(hand_png(2, 4, 16, 0, 0, raw, 12, NULL), "16 bits"),
              "16-bit PNG: %s", err);
    tap_check(refuses(hand_png(2, 4, 3, 0, 0, raw, 12, NULL), "depth 3"),
              "3-bit PNG: %s", err);
    tap_check(refuses(hand_png(2, 4, 4, 2, 0, raw, 12, NULL), "depth 4"),
              "4-bit RGB PNG: %s", err);
    tap_check(refuses(hand_png(2, 4, 8, 5, 0, raw, 12, NULL), "type 5"),
              "unknown colour type: %s", err);
    tap_check(refuses(hand_png(2, 4, 8, 3, 9, raw, 12, NULL), "outside"),
              "colour outside the palette: %s", err);
    tap_check(refuses(hand_png(2, 4, 8, 3, 0, raw, 12, NULL), "palette"),
              "no palette: %s", err);
    tap_check(refuses(hand_png(2, 4, 8, 0, 0, filter, 12, NULL), "filter 5"),
              "unknown filter: %s", err);
    tap_check(refuses(hand_png(2, 5, 8, 0, 0, raw, 12, NULL), "too few"),
              "too few rows: %s", err);
    tap_check(refuses(hand_png(2, 3, 8, 0, 0, raw, 12, NULL), "too many"),
              "too many rows: %s", err);
    tap_check(refuses(hand_png(0, 3, 8, 0, 0, raw, 12, NULL), "size 0 x 3"),
              "empty PNG: %s", err);
    tap_check(refuses(hand_png(65536, 1, 8, 0, 0, raw, 12, NULL), "65536"),
              "wide PNG: %s", err);
    tap_check(refuses(hand_png(65535, 65535, 8, 6, 0, raw, 12, NULL), "large"),
              "huge PNG: %s", err);
    tap_check(refuses(hand_png(65535, 8000, 8, 6, 0, raw, 12, NULL), "few"),
              "large PNG of few bytes: %s", err);
    tap_check(refuses(hand_png(2, 4, 8, 0, 0, raw, 12, "XXXX"), "XXXX"),
              "unknown critical chunk: %s", err);
    f = hand_png(2, 4, 8, 0, 0, raw, 12, NULL);
    f.data[20] ^= 1;
    tap_check(refuses(f, "CRC"), "damaged chunk: %s", err);
    put_signature(&f);
    put_chunk(&f, "IEND", raw, 0);
    tap_check(refuses(f, "header"), "PNG without header: %s", err);
}

/// Round trips through files in memory ///

static int png_trip(const struct image *image)
{
    struct image_file f = {NULL, 0};
    struct image back;
    int good = image_png_encode(image, &f, err, sizeof err) == 0 &&
               image_png_decode(f.data, f.size, &back, err, sizeof err) == 0;

    if (good) {
        good = same_image(image, &back);
        image_free(&back);
    }
    free(f.data);
    return good;
}

static void test_png_trips(void)
{
    struct image image, back;
    struct image_file f;
    int good = 1;

    for (int w = 1; w <= 19; w++)
        for (int h = 1; h <= 19; h++)
            for (int k = 0; k < 8; k++) {
                image = make_image((enum kind)(k / 2), w, h, k % 2 ? 3 : 1);
                if (image.channels == 3)
                    image.u8[0] = (uint8_t)(image.u8[1] ^ 1);
                good = good && png_trip(&image);
                image_free(&image);
            }
    tap_check(good, "PNG round trips of 1x1 to 19x19, grey and RGB");
    image = make_image(CLOUD, 1023, 767, 3);
    tap_check(png_trip(&image), "PNG round trip of 1023x767 RGB");
    for (size_t i = 0; i < image_samples(&image); i++)
        image.u8[i] = image.u8[i - i % 3];
    good = image_png_encode(&image, &f, err, sizeof err) == 0 &&
           image_png_decode(f.data, f.size, &back, err, sizeof err) == 0 &&
           back.channels == 1 && f.data[25] == 0;
    for (size_t i = 0; good && i < image_samples(&back); i++)
        good = back.u8[i] == image.u8[3 * i];
    tap_check(good, "RGB with equal channels becomes a grey PNG");
    free(f.data);
    image_free(&image);
    image_free(&back);
}

static struct image make_floats(int w, int h, int channels)
{
    struct image image;

    if (image_new_f32(&image, w, h, channels, err, sizeof err))
        must(NULL);
    for (size_t i = 0; i < image_samples(&image); i++)
        image.f32[i] = (float)(int)next_random() / 65536.0f;
    return image;
}

static int pfm_trip(int w, int h, int channels)
{
    struct image image = make_floats(w, h, channels), back;
    struct image_file f = {NULL, 0};
    int good = image_pfm_encode(&image, &f, err, sizeof err) == 0 &&
               image_pfm_decode(f.data, f.size, &back, err, sizeof err) == 0;

    if (good) {
        good = same_image(&image, &back);
        image_free(&back);
    }
    image_free(&image);
    free(f.data);
    return good;
}

static void test_pfm(void)
{
    static const uint8_t little[] = "Pf\n1 2\n-1.0\n\0\0\x80\x3F\0\0\0\xC0";
    static const uint8_t big[] = "PF 1 1 2.5\n\x3F\x80\0\0\xC0\0\0\0\0\0\0";
    static const uint8_t nan[] = "Pf\n1 2\n-1\n\0\0\0\0\0\0\xC0\x7F";
    struct image image;
    struct image_file f = {NULL, 0};
    int good;

    tap_check(pfm_trip(1, 1, 1) && pfm_trip(7, 5, 1) && pfm_trip(5, 9, 3),
              "PFM round trips");
    good = image_pfm_decode(little, sizeof little - 1, &image, err,
                            sizeof err) == 0 &&
           image.f32[0] == -2.0f && image.f32[1] == 1.0f &&
           image_pfm_encode(&image, &f, err, sizeof err) == 0 &&
           f.size == sizeof little - 1 && memcmp(f.data, little, f.size) == 0;
    tap_check(good, "PFM has the bottom row first, little-endian");
    free(f.data);
    image.f32[1] = NAN;
    f.data = NULL;
    tap_check(image_pfm_encode(&image, &f, err, sizeof err) &&
                  strstr(err, "NaN at row 1, column 0"),
              "PFM writer refuses NaN: %s", err);
    free(f.data);
    image_free(&image);
    good = image_pfm_decode(big, sizeof big, &image, err, sizeof err) == 0 &&
           image.channels == 3 && image.f32[0] == 1.0f &&
           image.f32[1] == -2.0f && image.f32[2] == 0.0f;
    tap_check(good, "big-endian PFM");
    image_free(&image);
    tap_check(image_pfm_decode(nan, sizeof nan - 1, &image, err, sizeof err) &&
                  strstr(err, "NaN at row 0, column 0"),
              "PFM: %s", err);
}

/* Decode PNM text; the samples, for at most 8, as comma-separated numbers,
 * or the message. */
static const char *pnm_text(const char *data, size_t size)
{
    static char text[ERR_SIZE];
    struct image image;
    size_t at = 0;

    if (image_pnm_decode((const uint8_t *)data, size, &image, text,
                         sizeof text))
        return text;
    for (size_t i = 0; i < image_samples(&image) && i < 8; i++)
        at += (size_t)sprintf(text + at, i ? ",%d" : "%d", image.u8[i]);
    image_free(&image);
    return text;
}

#define PNM_IS(data, words, name) \
    tap_check(strstr(pnm_text(data, sizeof data - 1), words), name ": %s", \
              pnm_text(data, sizeof data - 1))

static void test_pnm(void)
{
    PNM_IS("P5\n2 1\n255\nAB", "65,66", "PGM");
    PNM_IS("P6 1 1 255\nABC", "65,66,67", "PPM");
    PNM_IS("P5 # a\n# b 9\n2 # c\n1\n#d\n100\n\x64\x32", "255,128",
           "comments and maxval 100");
    PNM_IS("P5\n3 1\n255\n\n\r#", "10,13,35", "pixels that look like space");
    PNM_IS("P5\n1 1\n65535\nAB", "16-bit", "16 bits");
    PNM_IS("P5\n1 1\n65536\nAB", "maxval must be", "maxval");
    PNM_IS("P5\n1 2\n7\n\7\10", "row 1: sample 8 above", "sample");
    PNM_IS("P3\n1 1\n255\n1 2 3", "P5 or P6", "plain PPM");
    PNM_IS("P5\n2 1\n255\nA", "truncated", "short");
    PNM_IS("P5\n2 1\n255", "truncated", "no pixels");
    PNM_IS("P5\n65536 1\n255\n", "width must be", "wide");
    PNM_IS("P5\n0 1\n255\n", "width must be", "no width");
    PNM_IS("P5\n65535 65535\n255\n", "truncated", "huge");
    PNM_IS("P5\n-1 1\n255\n", "bad width", "negative");
    PNM_IS("P5\n1e1 1\n255\n", "bad width", "not whole");
    PNM_IS("P5\n99999999999999999999 1\n255\n", "width must be", "enormous");
    PNM_IS("P5\n99999999999999999999999999999999999999 1\n255\n", "bad width",
           "longer than any number");
    PNM_IS("", "does not start", "empty");
}

/// Corrupt files ///

typedef int decoder_fn(const uint8_t *, size_t, struct image *, char *, size_t);

/* Decode a private copy; whatever comes out must be an image or a line. */
static int survives(decoder_fn *decode, const uint8_t *data, size_t size)
{
    uint8_t *exact = copy_of(data, size);
    struct image image;
    int failed, good;
    uint32_t sum = 0;

    err[0] = '\0';
    failed = decode(exact, size, &image, err, sizeof err);
    if (failed) {
        good = err[0] && !strchr(err, '\n') && !image.u8 && !image.f32;
    } else {
        size_t n = image_samples(&image);
        good = n > 0 && !image.u8 != !image.f32;
        for (size_t i = 0; good && i < n; i++)
            sum += image.u8 ? image.u8[i] : image.f32[i] > 0;
        good = good && sum <= 255 * n;
        image_free(&image);
    }
    free(exact);
    return good;
}

/* Make every chunk's CRC right again, so that damage gets past them. */
static void repair_crcs(uint8_t *p, size_t size)
{
    size_t pos = 8;

    while (size - pos >= 12) {
        size_t n = (size_t)p[pos] << 24 | (size_t)p[pos + 1] << 16 |
                   (size_t)p[pos + 2] << 8 | p[pos + 3];
        if (n > size - pos - 12)
            return;
        put_be32(p + pos + 8 + n, deflate_crc32(0, p + pos + 4, n + 4));
        pos += 12 + n;
    }
}

static void corrupt(const char *name, decoder_fn *decode, struct image_file f,
                    int flips)
{
    int good = 1;

    for (size_t n = 0; n < f.size; n++)
        good = good && survives(decode, f.data, n);
    tap_check(good, "%s cut at each of %lu places", name,
              (unsigned long)f.size);
    good = 1;
    for (int i = 0; i < flips; i++) {
        uint8_t *bad = copy_of(f.data, f.size);
        for (uint32_t n = 1 + next_random() % 3; n > 0; n--) {
            size_t at = next_random() % f.size;
            if (i % 3 == 0 && f.size > 64)
                at %= 64; /* headers are where it hurts */
            bad[at] ^= (uint8_t)(1u << next_random() % 8);
        }
        if (decode == image_png_decode && i % 4 != 0)
            repair_crcs(bad, f.size);
        good = good && survives(decode, bad, f.size);
        free(bad);
    }
    tap_check(good, "%s with flipped bits, %d times", name, flips);
    free(f.data);
}

static void test_corrupt(void)
{
    struct image large_grey = make_image(CLOUD, 101, 67, 1);
    struct image large_rgb = make_image(CLOUD, 101, 67, 3);
    struct image grey = make_image(NOISE, 29, 23, 1);
    struct image rgb = make_image(NOISE, 29, 23, 3);
    struct image floats = make_floats(9, 7, 3);
    struct image_file f;
    uint8_t raw[10 * (1 + 10)] = {0};

    image_png_encode(&large_grey, &f, err, sizeof err);
    corrupt("grey PNG", image_png_decode, f, 6000);
    image_png_encode(&large_rgb, &f, err, sizeof err);
    corrupt("RGB PNG", image_png_decode, f, 6000);
    f = hand_png(19, 10, 4, 3, 16, raw, sizeof raw, NULL);
    corrupt("palette PNG", image_png_decode, f, 6000);
    image_pnm_encode(&grey, 1, &f, err, sizeof err);
    corrupt("PGM", image_pnm_decode, f, 3000);
    image_pnm_encode(&rgb, 3, &f, err, sizeof err);
    corrupt("PPM", image_pnm_decode, f, 3000);
    image_pfm_encode(&floats, &f, err, sizeof err);
    corrupt("PFM", image_pfm_decode, f, 3000);
    image_free(&large_grey);
    image_free(&large_rgb);
    image_free(&grey);
    image_free(&rgb);
    image_free(&floats);
}

/// Files on disk ///

static int disk_trip(const char *name, const struct image *image)
{
    struct image back;
    int good = image_write(in_dir(name), image, err, sizeof err) == 0 &&
               image_read(in_dir(name), &back, err, sizeof err) == 0;

    if (good) {
        good = same_image(image, &back);
        image_free(&back);
    }
    return good;
}

static void test_disk(void)
{
    struct image grey = make_image(NOISE, 13, 9, 1), back;
    struct image rgb = make_image(NOISE, 13, 9, 3);
    struct image floats = make_floats(13, 9, 3);
    int before;

    tap_check(disk_trip("a.png", &grey) && disk_trip("b.PNG", &rgb) &&
                  disk_trip("a.pgm", &grey) && disk_trip("a.Ppm", &rgb) &&
                  disk_trip("a.pfm", &floats),
              "files of each format");
    before = files_in_dir();
    tap_check(before == 5, "no file besides the five written");
    tap_check(image_write(in_dir("g.ppm"), &grey, err, sizeof err) == 0 &&
                  image_read(in_dir("g.ppm"), &back, err, sizeof err) == 0 &&
                  back.channels == 3 && back.u8[5] == grey.u8[1],
              "PPM repeats grey");
    image_free(&back);
    tap_check(image_write(in_dir("h.pfm"), &grey, err, sizeof err) == 0 &&
                  image_read(in_dir("h.pfm"), &back, err, sizeof err) == 0 &&
                  back.f32[8] == (float)grey.u8[8] / 255,
              "PFM of an 8-bit image");
    image_free(&back);
    tap_check(image_write(in_dir("x.pgm"), &rgb, err, sizeof err) &&
                  strstr(err, "x.pgm: RGB"),
              "RGB as PGM is refused");
    tap_check(image_write(in_dir("x.png"), &floats, err, sizeof err) &&
                  strstr(err, "x.png: float"),
              "float as PNG is refused");
    tap_check(image_write(in_dir("x.jpg"), &rgb, err, sizeof err) &&
                  strstr(err, ".png .ppm .pgm .pfm"),
              "unknown extension is refused");
    tap_check(image_write(in_dir("no/x.png"), &rgb, err, sizeof err) &&
                  strstr(err, "no/x.png: cannot write"),
              "missing directory is refused");
    tap_check(image_read(in_dir("none.png"), &back, err, sizeof err) &&
                  strstr(err, "none.png: cannot open"),
              "missing file");
    tap_check(image_read(dir, &back, err, sizeof err) &&
                  strstr(err, "unknown extension"),
              "no extension");
    tap_check(files_in_dir() == before + 2, "failures leave no file");
    image_free(&grey);
    image_free(&rgb);
    image_free(&floats);
}

/* A limit on the file size stands in for a full disk. */
static void test_full_disk(void)
{
    struct image old = make_image(FLAT, 4, 4, 1);
    struct image large = make_image(NOISE, 64, 64, 3), back;
    struct rlimit limit, full;
    int files, failed;

    image_write(in_dir("full.png"), &old, err, sizeof err);
    files = files_in_dir();
    getrlimit(RLIMIT_FSIZE, &limit);
    full = limit;
    full.rlim_cur = 1000;
    fflush(stdout);
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &full);
    failed = image_write(in_dir("full.png"), &large, err, sizeof err);
    setrlimit(RLIMIT_FSIZE, &limit);
    tap_check(failed && strstr(err, "cannot write"), "full disk is noticed");
    tap_check(image_read(in_dir("full.png"), &back, err, sizeof err) == 0 &&
                  same_image(&old, &back) && files_in_dir() == files,
              "full disk: the old file stays, nothing is left over");
    image_free(&back);
    if (access("/dev/full", W_OK) == 0 &&
        symlink("/dev/full", in_dir("dev.png")) == 0)
        tap_check(image_write(in_dir("dev.png"), &large, err, sizeof err) &&
                      access("/dev/full", W_OK) == 0,
                  "a device is written directly");
    else
        tap_skip("a device is written directly: no /dev/full");
    image_free(&old);
    image_free(&large);
}

/// Compare ///

static int near(double a, double b)
{
    return fabs(a - b) < 1e-9;
}

static void test_metrics(void)
{
    struct image a, b;
    struct metrics_error r;

    image_new_u8(&a, 10, 9, 1, err, sizeof err);
    image_new_u8(&b, 10, 9, 1, err, sizeof err);
    tap_check(metrics_error(&a, &b, &r, err, sizeof err) == 0 && r.rmse == 0 &&
                  r.mean == 0 && r.max == 0 && r.worst_tile == 0 &&
                  isinf(r.psnr) && r.psnr > 0,
              "identical images");
    b.u8[0] = 30; /* in a whole tile */
    a.u8[89] = 6; /* in the corner tile, 2 x 1 pixels */
    tap_check(metrics_error(&a, &b, &r, err, sizeof err) == 0, "two differ");
    tap_check(near(r.rmse, sqrt((900 + 36) / 90.0)), "rmse %f", r.rmse);
    tap_check(near(r.mean, 24 / 90.0), "mean %f", r.mean);
    tap_check(near(r.max, 30), "max %f", r.max);
    tap_check(near(r.psnr, 10 * log10(65025 / 10.4)), "psnr %f", r.psnr);
    tap_check(near(r.worst_tile, sqrt(36 / 2.0)), "worst tile %f",
              r.worst_tile);
    image_free(&b);
    image_new_u8(&b, 10, 9, 3, err, sizeof err);
    b.u8[89 * 3 + 1] = 9; /* grey 6 against (0, 9, 0) */
    tap_check(metrics_error(&a, &b, &r, err, sizeof err) == 0 &&
                  near(r.rmse, sqrt((36 + 9 + 36) / 270.0)) &&
                  near(r.mean, -9 / 270.0) && near(r.max, 6),
              "grey against RGB");
    image_free(&b);
    image_new_f32(&b, 10, 9, 1, err, sizeof err);
    b.f32[0] = 2.0f;
    b.f32[89] = 6.0f / 255;
    tap_check(metrics_error(&a, &b, &r, err, sizeof err) == 0 &&
                  fabs(r.max - 510) < 1e-4 &&
                  fabs(r.mean - 510 / 90.0) < 1e-4 &&
                  fabs(r.worst_tile - 510 / 8.0) < 1e-4,
              "8 bits against float");
    b.width = 9;
    tap_check(metrics_error(&a, &b, &r, err, sizeof err) &&
                  strstr(err, "10 x 9 and 9 x 9"),
              "%s", err);
    image_free(&a);
    image_free(&b);
}

/* Run the command in a child, with its output in the files out and err of the
 * directory. Returns its exit status. */
static int run_compare(const char *a, const char *b, const char *c,
                       const char *d)
{
    char text[5][PATH_SIZE] = {"compare"}, *argv[6] = {text[0]};
    const char *arg[4];
    int argc = 1, status = -1;
    pid_t child;

    arg[0] = a, arg[1] = b, arg[2] = c, arg[3] = d;
    for (; argc < 5 && arg[argc - 1]; argc++) {
        snprintf(text[argc], PATH_SIZE, "%s", arg[argc - 1]);
        argv[argc] = text[argc];
    }
    fflush(stdout);
    child = fork();
    if (child == 0) {
        must(freopen(in_dir("out"), "wb", stdout));
        must(freopen(in_dir("err"), "wb", stderr));
        status = compare_main(argc, argv);
        fflush(stdout);
        fflush(stderr);
        _exit(status);
    }
    if (child < 0 || waitpid(child, &status, 0) != child)
        must(NULL);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/* Whether the child wrote exactly one line to stderr, holding `words`. */
static int one_line(const char *words)
{
    char text[2 * PATH_SIZE], *end;

    get_text(in_dir("err"), text, sizeof text);
    end = strchr(text, '\n');
    return strncmp(text, "brume compare: ", 15) == 0 && strstr(text, words) &&
           end && end[1] == '\0' && file_size(in_dir("out")) == 0;
}

static void test_command(void)
{
    static const char *const expected =
        "rmse=1.000000\nmean=-0.500000\npsnr=48.130804\nmax=2.000000\n"
        "worst_tile=1.000000\nssim=nan\n";
    char text[PATH_SIZE], a[PATH_SIZE], b[PATH_SIZE], c[PATH_SIZE];

    snprintf(a, sizeof a, "%s", in_dir("ca.pgm"));
    snprintf(b, sizeof b, "%s", in_dir("cb.pgm"));
    snprintf(c, sizeof c, "%s", in_dir("cc.pgm"));
    put_file(a, "P5 4 1 255\n\2\2\2\2", 15);
    put_file(b, "P5 4 1 255\n\2\2\2\0", 15);
    put_file(c, "P5 1 4 255\n\2\2\2\0", 15);
    tap_check(run_compare(a, b, NULL, NULL) == 0, "compare exits with 0");
    get_text(in_dir("out"), text, sizeof text);
    tap_check(strncmp(text, expected, strlen(expected)) == 0,
              "compare prints name=value");
    tap_check(run_compare(a, a, NULL, NULL) == 0, "compare with itself");
    get_text(in_dir("out"), text, sizeof text);
    tap_check(strstr(text, "\npsnr=inf\n") != NULL, "psnr=inf");
    tap_check(run_compare(a, b, "--max-rmse", "1") == 0, "not above 1");
    tap_check(run_compare("--max-rmse", "0.9", a, b) == 1, "above 0.9");
    tap_check(run_compare(a, c, NULL, NULL) == 2 && one_line("sizes differ"),
              "sizes differ");
    tap_check(run_compare(a, NULL, NULL, NULL) == 2 && one_line("two"),
              "one picture");
    tap_check(run_compare(a, b, c, NULL) == 2 && one_line("more than two"),
              "three pictures");
    tap_check(run_compare(a, b, "--max-rmse", NULL) == 2 && one_line("number"),
              "--max-rmse without number");
    tap_check(run_compare(a, b, "--max-rmse", "1x") == 2 && one_line("1x"),
              "--max-rmse with junk");
    tap_check(run_compare(a, "--what", NULL, NULL) == 2 && one_line("--what"),
              "unknown option");
    tap_check(run_compare(a, "x.jpg", NULL, NULL) == 2 && one_line("x.jpg"),
              "unknown extension");
    tap_check(run_compare("--help", NULL, NULL, NULL) == 0 &&
                  file_size(in_dir("err")) == 0 && file_size(in_dir("out")) > 0,
              "--help");
}

/// Against netpbm and pngcheck ///

static int matches_pnm(const char *png, const char *pnm)
{
    struct image a, b;
    struct metrics_error r;
    int good = image_read(in_dir(png), &a, err, sizeof err) == 0;

    if (!good)
        return 0;
    good = image_read(in_dir(pnm), &b, err, sizeof err) == 0;
    if (good)
        good = metrics_error(&a, &b, &r, err, sizeof err) == 0 && r.max == 0;
    image_free(&a);
    image_free(&b);
    return good;
}

/* Depth, colour type and interlace of a PNG file, as in 814. */
static int png_type(const char *name)
{
    uint8_t head[29] = {0};
    FILE *f = fopen(in_dir(name), "rb");

    if (!f || fread(head, 1, sizeof head, f) != sizeof head)
        must(NULL);
    fclose(f);
    return head[24] * 100 + head[25] * 10 + head[28];
}

/* A noise picture of the given maxval; RGB ones draw from `colours`. */
static void make_pnm(const char *name, int channels, unsigned maxval,
                     unsigned colours)
{
    enum { W = 23, H = 17 };
    char data[64 + W * H * 3];
    size_t n = (size_t)sprintf(data, "P%d %d %d %u\n", channels == 1 ? 5 : 6, W,
                               H, maxval);

    for (int i = 0; i < W * H; i++) {
        uint32_t v = next_random();
        if (colours > 0)
            v = (v % colours + 1) * 0x9E3779B1u;
        for (int c = 0; c < channels; c++, v >>= 8)
            data[n++] =
                (char)(colours || maxval == 255 ? v & 255u : v % (maxval + 1));
    }
    put_file(in_dir(name), data, n);
}

static void test_pnmtopng_inputs(void)
{
    static const struct {
        int channels;
        unsigned maxval, colours;
        const char *options;
        int type;
    } input[] = {
        {1, 1, 0, "", 100},
        {1, 3, 0, "", 200},
        {1, 15, 0, "", 400},
        {1, 255, 0, "", 800},
        {3, 255, 0, "", 820},
        {3, 255, 2, "", 130},
        {3, 255, 4, "", 230},
        {3, 255, 16, "", 430},
        {3, 255, 200, "", 830},
        {1, 1, 0, "-interlace", 101},
        {1, 3, 0, "-interlace", 201},
        {1, 15, 0, "-interlace", 401},
        {1, 255, 0, "-interlace", 801},
        {3, 255, 0, "-interlace", 821},
        {3, 255, 2, "-interlace", 131},
        {3, 255, 4, "-interlace", 231},
        {3, 255, 16, "-interlace", 431},
        {3, 255, 200, "-interlace", 831},
        {1, 255, 0, "-force -alpha=alpha.pgm", 840},
        {3, 255, 0, "-alpha=alpha.pgm", 860},
        {1, 255, 0, "-force -interlace -alpha=alpha.pgm", 841},
        {3, 255, 0, "-interlace -alpha=alpha.pgm", 861},
        {3, 255, 16, "-transparent=black", 430},
    };
    char command[PATH_SIZE];

    make_pnm("alpha.pgm", 1, 255, 0);
    for (size_t i = 0; i < sizeof input / sizeof *input; i++) {
        const char *name = input[i].channels == 1 ? "in.pgm" : "in.ppm";
        if (!have_tool("pnmtopng")) {
            tap_skip("PNG of type %d: no pnmtopng", input[i].type);
            continue;
        }
        make_pnm(name, input[i].channels, input[i].maxval, input[i].colours);
        snprintf(command, sizeof command, "pnmtopng %s %s >in.png 2>/dev/null",
                 input[i].options, name);
        tap_check(shell(command) == 0 && matches_pnm("in.png", name) &&
                      png_type("in.png") == input[i].type,
                  "PNG of pnmtopng, type %d%s%s", input[i].type,
                  input[i].options[0] ? " " : "", input[i].options);
    }
}

/* One of our PNGs: valid, read the same by libpng, and not much larger. */
static void against_libpng(const char *name, const struct image *image)
{
    long ours, theirs;

    if (!tap_check(image_write(in_dir("our.png"), image, err, sizeof err) == 0,
                   "%s written", name))
        return;
    if (have_tool("pngcheck"))
        tap_check(shell("pngcheck -q our.png >/dev/null") == 0,
                  "%s: pngcheck accepts it", name);
    else
        tap_skip("%s: no pngcheck", name);
    if (have_tool("pngtopnm"))
        tap_check(shell("pngtopnm our.png >our.ppm") == 0 &&
                      matches_pnm("our.png", "our.ppm"),
                  "%s: pngtopnm reads the same", name);
    else
        tap_skip("%s: no pngtopnm", name);
    if (!have_tool("pnmtopng") || !have_tool("pngtopnm")) {
        tap_skip("%s: no pnmtopng to compare sizes", name);
        return;
    }
    shell("pnmtopng our.ppm >their.png 2>/dev/null");
    ours = file_size(in_dir("our.png"));
    theirs = file_size(in_dir("their.png"));
    tap_check((double)ours <= 1.3 * (double)theirs, "%s: %ld bytes, libpng %ld",
              name, ours, theirs);
}

static void test_against_libpng(void)
{
    static const struct {
        const char *name;
        enum kind kind;
        int width, height;
    } picture[] = {
        {"1x1", NOISE, 1, 1},
        {"odd size", CLOUD, 101, 67},
        {"gradient", GRADIENT, 960, 540},
        {"noise", NOISE, 960, 540},
        {"cloud", CLOUD, 960, 540},
    };
    char name[64];

    for (size_t i = 0; i < sizeof picture / sizeof *picture; i++)
        for (int channels = 1; channels <= 3; channels += 2) {
            struct image image = make_image(picture[i].kind, picture[i].width,
                                            picture[i].height, channels);
            snprintf(name, sizeof name, "%s %s", picture[i].name,
                     channels == 1 ? "grey" : "RGB");
            against_libpng(name, &image);
            image_free(&image);
        }
}

static void remove_dir(void)
{
    DIR *d = opendir(dir);
    struct dirent *entry;

    while (d && (entry = readdir(d)))
        if (entry->d_name[0] != '.')
            unlink(in_dir(entry->d_name));
    if (d)
        closedir(d);
    rmdir(dir);
}

int main(void)
{
    const char *base = getenv("TMPDIR");

    snprintf(dir, sizeof dir, "%s/brume_image_XXXXXX",
             base && *base ? base : "/tmp");
    must(mkdtemp(dir));
    test_vectors();
    test_round_trips();
    test_hostile_streams();
    test_hand_png();
    test_random_rows();
    test_bad_png();
    test_png_trips();
    test_pfm();
    test_pnm();
    test_corrupt();
    test_disk();
    test_full_disk();
    test_metrics();
    test_command();
    test_pnmtopng_inputs();
    test_against_libpng();
    remove_dir();
    return tap_done();
}
