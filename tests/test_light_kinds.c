/* SPDX-License-Identifier: MIT */
/*
 * Light by cones through the mips, and stochastic lookups: each against its
 * definition in docs/light.md, in double.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "brume_noise_tables.h"
#include "support/lit.h"
#include "tap.h"

#define ONE 0x10000u
#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))

enum { W = 40, H = 30, RAYS = W * H };

static struct brume_frame frame;
static struct brume_radiance first[RAYS], second[RAYS];

/// Cone ///

/* The segment of sample i of n: where its middle is and how long it is, in
 * light steps. */
static void segment_of(int i, int n, double *middle, double *length)
{
    static const double k_bound[] = {1,  4,   8,   12,  16,  24,  32,  48,  64,
                                     96, 128, 192, 256, 384, 512, 768, 1024};
    double low = k_bound[i], high = k_bound[i + 1];
    if (i >= 2 && i == n - 1)
        high += high - low;
    *middle = (low + high) / 2;
    *length = high - low;
}

/* Too near to a face or a cube's side to tell on which side it is, in voxels.
 */
#define NEAR (1.0 / 64)

/* A block of density 1. */
struct block {
    int cells[3], low[3], high[3];
};

/* Density of the mip of a segment at a position: the part of a cube of 2^level
 * voxels that is in the block, coded as docs/SPEC.md says; the block's own at
 * level 0 and below. -1: too near to tell. */
static double mip_density(const struct block *b, double length, double step,
                          const double p[3])
{
    int level = (int)floor(log2(length)) + (int)floor(log2(step)) - 1, q = 0;
    double side = level > 0 ? ldexp(1, level) : 1, mean = 65280;
    bool full = true;
    for (int a = 0; a < 3; a++) {
        double at = (p[a] + 0.5) / side, low = floor(at) * side;
        double to_side = fmin(at - floor(at), floor(at) + 1 - at) * side;
        double part = fmin(low + side, b->high[a]) - fmax(low, b->low[a]);
        if (level > 0 ? to_side < NEAR
                      : fmin(fabs(p[a] + 0.5 - b->low[a]),
                             fabs(p[a] + 0.5 - b->high[a])) < NEAR)
            return -1;
        mean *= fmax(part, 0) / side;
        full = full && p[a] + 0.5 > b->low[a] && p[a] + 0.5 < b->high[a];
    }
    if (level <= 0)
        return full ? 1 : 0;
    while ((q + 1.0) * (q + 1) < mean)
        q++;
    return q * (q + 1.0) / 65280;
}

/* Sum of the segments' lengths times their densities, [0, 1) too, until a
 * sample is outside of the pool; -1 when that cannot be told. */
static double cone_way(const struct block *b, const struct brume_scene *s,
                       const double from[3], const double sun[3])
{
    double way = 1, step = s->light_step / 65536.0;
    bool tri = s->filter == BRUME_TRILINEAR;
    for (int i = 0; i < s->light_samples; i++) {
        double middle, length, p[3];
        bool inside = true;
        segment_of(i, s->light_samples, &middle, &length);
        for (int a = 0; a < 3; a++) {
            double low = tri ? 0 : -0.5;
            double high = 8 * b->cells[a] - (tri ? 1 : 0.5);
            p[a] = from[a] + middle * step * sun[a];
            if (fabs(p[a] - low) < NEAR || fabs(p[a] - high) < NEAR)
                return -1;
            inside = inside && p[a] > low && p[a] < high;
        }
        if (!inside)
            break;
        double d = mip_density(b, length, step, p);
        if (d < 0)
            return -1;
        way += length * d;
    }
    return way;
}

/* The largest error of tau over a frame, where all samples together have 1, in
 * units of its bound: tau is rounded to 2^-12, a factor of its exponential to
 * 2^-15, light to 2^-16. */
static double cone_error(const struct lit_volume *v, const struct block *b,
                         struct brume_scene *s, int *rays)
{
    double worst = 0, sun[3], middle[3], length = 0, whole;
    for (int a = 0; a < 3; a++)
        length += (double)s->sun[a] * s->sun[a];
    for (int a = 0; a < 3; a++)
        sun[a] = s->sun[a] / sqrt(length);
    lit_sample_position(s, s->width / 2, s->height / 2, middle);
    whole = fmax(cone_way(b, s, middle, sun), 1);
    s->light_density_scale =
        (uint64_t)(4294967296.0 * 65536 / (whole * s->light_step));
    lit_march(&frame, v, s, first);
    for (int i = 0; i < s->width * s->height; i++) {
        double p[3];
        if (first[i].transmittance != 0)
            continue;
        lit_sample_position(s, i % s->width, i / s->width, p);
        double way = cone_way(b, s, p, sun);
        if (way < 0)
            continue;
        double tau = way * s->light_step / 65536.0 *
                     ldexp((double)s->light_density_scale, -32);
        double light = first[i].light / 65536.0, want = exp(-tau);
        double bound = want * ldexp(1, -13) + ldexp(1, -15) + ldexp(1, -17);
        worst = fmax(worst, fabs(light - want) / bound);
        ++*rays;
    }
    return worst;
}

/* Every light step and number of samples; filters 0 to `filters`. */
static void check_cone_block(const char *name, const struct block *b,
                             int filters)
{
    static const uint32_t k_step[] = {BRUME_MIN_STEP, ONE / 3,  ONE,
                                      5 * ONE / 2,    40 * ONE, BRUME_MAX_STEP};
    struct brume_lighting l = lit_white();
    struct lit_volume v = lit_block(b->cells, b->low, b->high, 65280);
    for (int n = 0; n < COUNT(k_step); n++) {
        double worst = 0;
        int rays = 0;
        for (int k = 0; k < 17 * filters; k++) {
            struct brume_scene s = lit_one_sample(&v, W, H, &l);
            s.light = BRUME_CONE;
            s.filter = (uint8_t)(k / 17);
            s.light_samples = (uint16_t)(k % 17);
            s.light_step = k_step[n];
            worst = fmax(worst, cone_error(&v, b, &s, &rays));
        }
        tap_check(worst <= 1 && rays > 17 * filters * RAYS / 8,
                  "cone, %s, light step %.3f: tau of %d rays within %.2f of "
                  "its bound",
                  name, k_step[n] / 65536.0, rays, worst);
    }
    lit_volume_free(&v);
}

/* A pool as long as can be, lit along it: no sample is lost that is inside. */
static void check_cone_far(void)
{
    static const uint32_t k_step[] = {ONE, 3 * ONE / 2, 16 * ONE,
                                      BRUME_MAX_STEP};
    static const struct block k_long = {
        {BRUME_MAX_CELLS, 1, 1}, {0, 0, 0}, {8 * BRUME_MAX_CELLS, 8, 8}};
    struct brume_lighting l = lit_white();
    struct lit_volume v =
        lit_block(k_long.cells, k_long.low, k_long.high, 65280);
    for (int n = 0; n < COUNT(k_step); n++) {
        double worst = 0;
        int rays = 0;
        for (uint16_t samples = 0; samples <= 16; samples++) {
            struct brume_scene s = lit_one_sample(&v, W, H, &l);
            int32_t back = s.target[0] - 8 * (int32_t)ONE;
            s.eye[0] -= back;
            s.target[0] -= back;
            s.light = BRUME_CONE;
            s.light_samples = samples;
            s.light_step = k_step[n];
            s.sun[0] = 1;
            s.sun[1] = s.sun[2] = 0;
            worst = fmax(worst, cone_error(&v, &k_long, &s, &rays));
        }
        tap_check(worst <= 1 && rays > 17 * RAYS / 20,
                  "cone along 32760 voxels, light step %.1f: tau of %d rays "
                  "within %.2f of its bound",
                  k_step[n] / 65536.0, rays, worst);
    }
    lit_volume_free(&v);
}

static void check_cone_section(void)
{
    static const struct density_box k_box = {{0, 0, 0}, {8, 8, 8}, 65280};
    struct asset_spec spec =
        asset_spec_of(1, 1, 1, BRUME_U8, density_in_box, &k_box);
    struct lit_volume v = lit_volume_of(&spec, NULL);
    struct brume_scene s = lit_scene(&v, 1, 1, NULL);
    s.light = BRUME_CONE;
    tap_check(brume_begin_frame(&frame, &v.volume, &s) == BRUME_ERR_SECTION,
              "cone: a volume without mips is refused");
    lit_volume_free(&v);
}

/// Stochastic ///

/* A noise, and how many frames it has that differ; 256 will do. */
static const struct lit_noise {
    const char *name;
    uint8_t noise;
    const struct brume_noise_table *table;
    uint32_t frames;
} noises[] = {
    {"white", BRUME_NOISE_WHITE, NULL, 256},
    {"rank1", BRUME_NOISE_RANK1, NULL, 256},
    {"ign", BRUME_NOISE_IGN, NULL, 256},
    {"ign_thesis", BRUME_NOISE_IGN_THESIS, NULL, 256},
    {"fast", BRUME_NOISE_TABLE, &brume_noise_fast, 32},
    {"stbn", BRUME_NOISE_TABLE, &brume_noise_stbn, 16},
    {"blue, golden ratio", BRUME_NOISE_TABLE_GOLDEN, &brume_noise_blue, 256},
    {"blue, R2", BRUME_NOISE_TABLE_R2, &brume_noise_blue, 256},
};

/* Of eight neighbours no two are alike: code 20 + 28 n by their parities. */
static uint32_t parity_of(int x, int y, int z)
{
    return (uint32_t)((x & 1) | (y & 1) << 1 | (z & 1) << 2);
}

static uint32_t density_by_parity(int x, int y, int z, const void *context)
{
    (void)context;
    return (20 + 28 * parity_of(x, y, z)) * 256;
}

/* Which of the eight a ray's transmittance tells of, or -1. Its codes are 18
 * apart at least, and wrong by one at most. */
static int voxel_seen(const struct brume_radiance *r)
{
    for (int n = 0; n < 8; n++)
        if (fabs(r->transmittance - 65536 * exp(-4 * (20 + 28 * n) / 255.0)) <=
            1)
            return n;
    return -1;
}

static void weights_at(const double p[3], double weight[8])
{
    for (int n = 0; n < 8; n++) {
        double w = 1;
        int at[3];
        for (int a = 0; a < 3; a++) {
            double low = floor(p[a]), part = p[a] - low;
            at[a] = (int)low + (n >> a & 1);
            w *= n >> a & 1 ? part : 1 - part;
        }
        weight[parity_of(at[0], at[1], at[2])] = w;
    }
}

enum { CHOICES = 1024 };

/* How often the one sample of each ray is which voxel; returns how often it is
 * none of them. */
static int count_voxels(const struct lit_volume *v, struct brume_scene *s,
                        int count[RAYS][8])
{
    int other = 0;
    memset(count, 0, RAYS * sizeof *count);
    for (s->frame = 0; s->frame < CHOICES; s->frame++) {
        lit_march(&frame, v, s, first);
        for (int i = 0; i < RAYS; i++) {
            int n = voxel_seen(&first[i]);
            if (n >= 0)
                count[i][n]++;
            else
                other += first[i].transmittance < ONE;
        }
    }
    return other;
}

/* Each sample is one of its eight voxels, as often as their weights say: a
 * share of 1024 frames has a standard error of 1/64 at most, and 5 of them are
 * allowed. */
static void check_voxel_choice(const struct lit_noise *n)
{
    static int count[RAYS][8];
    struct asset_spec spec =
        asset_spec_of(5, 4, 4, BRUME_U8, density_by_parity, NULL);
    struct lit_volume v = lit_volume_of(&spec, NULL);
    struct brume_lighting l = lit_white();
    struct brume_scene s = lit_one_sample(&v, W, H, &l);
    int rays = 0;
    double worst = 0;
    s.filter = BRUME_STOCHASTIC;
    s.light = BRUME_NO_LIGHT;
    s.noise = n->noise;
    s.noise_table = n->table;
    s.density_scale = BRUME_Q32(4.0 / 256);
    int other = count_voxels(&v, &s, count);
    for (int i = 0; i < RAYS; i++) {
        double p[3], weight[8];
        int sum = 0;
        lit_sample_position(&s, i % W, i / W, p);
        weights_at(p, weight);
        for (int k = 0; k < 8; k++)
            sum += count[i][k];
        for (int k = 0; k < 8 && sum > 0; k++)
            worst = fmax(worst, fabs((double)count[i][k] / sum - weight[k]));
        rays += sum == CHOICES;
    }
    tap_check(other == 0 && rays > RAYS / 2 && worst < 5.0 / 64,
              "stochastic, %s: each sample of %d rays is a voxel of its eight; "
              "shares of %d frames within %.3f of the weights",
              n->name, rays, CHOICES, worst);
    lit_volume_free(&v);
}

/* Mean and variance of rays' light over frames. */
struct mean {
    double sum[RAYS], square[RAYS];
};

static void march_mean(struct mean *m, const struct lit_volume *v,
                       struct brume_scene s, uint32_t frames)
{
    memset(m, 0, sizeof *m);
    for (s.frame = 0; s.frame < frames; s.frame++) {
        lit_march(&frame, v, &s, first);
        for (int i = 0; i < RAYS; i++) {
            m->sum[i] += first[i].light;
            m->square[i] += (double)first[i].light * first[i].light;
        }
    }
    for (int i = 0; i < RAYS; i++) {
        m->sum[i] /= frames;
        m->square[i] = m->square[i] / frames - m->sum[i] * m->sum[i];
    }
}

/* How far the means of rays in a rectangle are from the trilinear image in
 * `second`, in standard errors; that image is rounded, which is a twelfth. */
static double errors_off(const struct mean *m, uint32_t frames, int x, int y,
                         int w, int h)
{
    double off = 0, variance = 0;
    for (int k = 0; k < w * h; k++) {
        int i = (y + k / w) * W + x + k % w;
        off += m->sum[i] - second[i].light;
        variance += m->square[i] / frames + 1.0 / 12;
    }
    return fabs(off) / sqrt(variance);
}

/* So thin that light is linear in the density, and 256 times as bright; along
 * an axis, or oblique from either side (3, 4). */
static struct brume_scene thin_scene(const struct lit_volume *v,
                                     struct brume_lighting *l, int axis)
{
    struct brume_scene s = lit_scene(v, W, H, l);
    s.density_scale = s.light_density_scale = 0x100000000u >> 14;
    for (int c = 0; c < 3; c++)
        l->sun_colour[c] = 16 * ONE;
    l->exposure = 16 * ONE;
    if (axis < 3) {
        memcpy(s.eye, s.target, sizeof s.eye);
        s.eye[axis] -= 90 * (int32_t)ONE;
    }
    for (int a = 0; a < 3 && axis == 4; a++)
        s.eye[a] = 2 * s.target[a] - s.eye[a];
    return s;
}

/* Means over all frames of a noise: in regions of 8 x 6 rays, and over all. */
static void check_mean(const struct lit_volume *v, int axis,
                       const struct lit_noise *n)
{
    static const char *const k_way[] = {"along x", "along y", "along z",
                                        "oblique", "from behind"};
    static struct mean m;
    struct brume_lighting l = lit_white();
    struct brume_scene s = thin_scene(v, &l, axis);
    double region = 0;
    s.noise = n->noise;
    s.noise_table = n->table;
    s.filter = BRUME_TRILINEAR;
    lit_march(&frame, v, &s, second);
    s.filter = BRUME_STOCHASTIC;
    march_mean(&m, v, s, n->frames);
    for (int i = 0; i < RAYS / 48; i++)
        region = fmax(region, errors_off(&m, n->frames, i % (W / 8) * 8,
                                         i / (W / 8) * 6, 8, 6));
    double all = errors_off(&m, n->frames, 0, 0, W, H);
    tap_check(region < 4 && all < 4,
              "%s, stochastic, %s, %s: means of %u frames within %.2f standard "
              "errors of trilinear, over all %.2f",
              v->name, n->name, k_way[axis], n->frames, region, all);
}

static void check_means(const struct lit_volume *v)
{
    for (int axis = 0; axis < 5; axis++)
        check_mean(v, axis, &noises[0]);
    for (int i = 1; i < COUNT(noises); i++)
        check_mean(v, 3 + i % 2, &noises[i]);
}

int main(void)
{
    struct lit_volume cloud = lit_cloud(1), cell = lit_middle_cell();
    static const struct block k_full = {{5, 4, 3}, {0, 0, 0}, {40, 32, 24}};
    static const struct block k_part = {
        {18, 14, 11}, {60, 45, 37}, {87, 69, 55}};
    check_cone_block("full pool", &k_full, 2);
    check_cone_block("block", &k_part, 1);
    check_cone_far();
    check_cone_section();
    for (int i = 0; i < COUNT(noises); i++)
        if (noises[i].frames == 256)
            check_voxel_choice(&noises[i]);
    check_means(&cloud);
    check_means(&cell);
    lit_volume_free(&cloud);
    lit_volume_free(&cell);
    return tap_done();
}
