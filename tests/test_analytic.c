/* SPDX-License-Identifier: MIT */
/*
 * The renderer against closed forms, through the public API alone: volumes and
 * cameras whose image can be written down, rendered and compared in double.
 *
 * Most frames here are one pixel, whose ray is the camera's axis; along an
 * axis of the pool its samples are at known places to the bit. A homogeneous
 * block that such a ray crosses over L voxels, with faces on the lattice t_k,
 * takes exactly L / step samples, as one of its faces belongs to it.
 *
 * Radiance is measured in units of 1/65536, those of BRUME_L16, with bounds
 * made of the following.
 */
#include <math.h>
#include <stdlib.h>

#include "brume.h"
#include "support/asset_builder.h"
#include "tap.h"

static const double unit = 1.0 / 65536;
static const double degree = 3.14159265358979323846 / 180;

/* Without a sun: half a unit of rounding; one where 65535 stands for 65536;
 * a quarter for up to 2^11 samples, each truncated to 2^-29; the rest for
 * opacities, right to 2^-22 of their value. */
static const double precision = 2.0 / 65536;

/* The sun's transmittance: its optical depth is rounded to 1/4096, and the
 * two factors looked up for it to 1/32768 each. */
static const double sun_precision = 1.0 / 8192 + 1.0 / 32768;

/// Harness ///

struct asset {
    uint8_t *bytes;
    struct brume_volume volume;
};

static struct asset asset_of(const struct asset_spec *spec)
{
    struct asset a;
    size_t size;
    a.bytes = asset_build(spec, &size);
    if (brume_volume_open(&a.volume, a.bytes, size, 0) != BRUME_OK)
        abort();
    return a;
}

/* The density 1 in a box of voxels, low <= p < high. */
static struct asset box_asset(int cx, int cy, int cz, int format,
                              struct density_box box)
{
    struct asset_spec spec =
        asset_spec_of(cx, cy, cz, format, density_in_box, &box);
    return asset_of(&spec);
}

/* The cube of most tests: 16 voxels a side, in the middle of 32. Its faces
 * are at 7.5 and 23.5. */
static struct asset cube_asset(int format)
{
    const struct density_box box = {{8, 8, 8}, {24, 24, 24}, 65280};
    return box_asset(4, 4, 4, format, box);
}

/* One white-albedo pixel of density_scale 1, unlit: what a test does not
 * change is as simple as can be. */
static struct brume_scene plain_scene(void)
{
    struct brume_scene s = {.width = 1, .height = 1};
    s.up[1] = 1;
    s.fov = 30u << 16;
    s.sun[1] = 1;
    s.density_scale = s.light_density_scale = (uint64_t)1 << 32;
    s.albedo = 0x10000u;
    s.step = s.light_step = 0x10000u;
    s.filter = BRUME_NEAREST;
    s.light = BRUME_NO_LIGHT;
    s.output = BRUME_LINEAR;
    s.skip = true;
    return s;
}

static void set_eye(struct brume_scene *s, double x, double y, double z)
{
    s->eye[0] = BRUME_Q16(x);
    s->eye[1] = BRUME_Q16(y);
    s->eye[2] = BRUME_Q16(z);
}

/* Looks along an axis: 0 1 2 for +x +y +z, 3 4 5 for -x -y -z. */
static void look_along(struct brume_scene *s, int direction)
{
    int axis = direction % 3;
    for (int i = 0; i < 3; i++) {
        s->target[i] = s->eye[i];
        s->up[i] = i == (axis + 1) % 3;
    }
    s->target[axis] += direction < 3 ? 65536 : -65536;
}

static void set_sun(struct brume_scene *s, int direction)
{
    for (int i = 0; i < 3; i++)
        s->sun[i] = i != direction % 3 ? 0 : direction < 3 ? 3 : -3;
}

/* Along the row of voxels y, z, from before the pool. */
static void look_along_x(struct brume_scene *s, double x, double y, double z)
{
    set_eye(s, x, y, z);
    look_along(s, 0);
}

static double scale_of(uint64_t q32)
{
    return ldexp((double)q32, -32);
}

static uint64_t q32_of(double v)
{
    return (uint64_t)ldexp(v, 32);
}

/* A whole frame in BRUME_L16; false on any error. */
static bool render(const struct asset *a, const struct brume_scene *s,
                   uint16_t *to)
{
    struct brume_frame f;
    return brume_begin_frame(&f, &a->volume, s) == BRUME_OK &&
           brume_render_rect(&f, 0, 0, s->width, s->height, BRUME_L16, to,
                             2 * (size_t)s->width) == BRUME_OK;
}

/* The one pixel; an error fails any comparison. */
static double radiance(const struct asset *a, const struct brume_scene *s)
{
    uint16_t code = 0;
    return render(a, s, &code) ? code * unit : (double)NAN;
}

/* The greatest of the errors, also when one is no number. */
static void note(double *worst, double got, double expected)
{
    double error = fabs(got - expected);
    if (!(error <= *worst))
        *worst = error;
}

static void check_worst(const char *what, double worst, double bound)
{
    tap_check(worst <= bound, "%s: error %.2f <= %.2f / 65536", what,
              worst / unit, bound / unit);
}

static uint32_t random_word(void)
{
    static uint32_t state = 0x193a6754u;
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return state;
}

static double random_between(double low, double high)
{
    return low + (high - low) * ldexp(random_word(), -32);
}

static const char *format_name(int format)
{
    return format == BRUME_U8 ? "u8" : format == BRUME_U8R ? "u8r" : "u4r";
}

/// Slab ///

/* sigma_t from 1e-4 to 1e3 per voxel. */
static double slab_error(const struct asset *a, int length, uint32_t step)
{
    struct brume_scene s = plain_scene();
    double worst = 0;
    look_along_x(&s, -6.5, 12, 12);
    s.step = step;
    for (int i = 0; i <= 42; i++) {
        s.density_scale = q32_of(pow(10, i / 6.0 - 4));
        double depth = scale_of(s.density_scale) * length;
        note(&worst, radiance(a, &s), 1 - exp(-depth));
    }
    return worst;
}

static void test_slab(int format)
{
    static const int lengths[] = {1, 2, 7, 8, 16, 40};
    double worst = 0;
    for (int i = 0; i < 6; i++) {
        int length = lengths[i];
        const struct density_box box = {
            {10, 4, 4}, {10 + length, 20, 20}, 65280};
        struct asset a = box_asset(8, 3, 3, format, box);
        for (uint32_t step = 0x10000u; step >= 0x4000u; step /= 2)
            worst = fmax(worst, slab_error(&a, length, step));
        free(a.bytes);
    }
    char name[40];
    snprintf(name, sizeof name, "slab, %s: 1 - exp(-sigma_t L)",
             format_name(format));
    check_worst(name, worst, precision);
}

/* Losses that a coarser fixed point would swallow: 1024 samples that each
 * take a millionth. The mean error over many of them sees a bias well below
 * the rounding of one: 1/8 unit for truncating 1024 times by up to 2^-29,
 * and as much for the rounding of 64 pixels, 0.29 / sqrt(64) three times. */
static void test_faint_rays(int format)
{
    const struct density_box box = {{10, 4, 4}, {74, 20, 20}, 65280};
    struct asset a = box_asset(11, 3, 3, format, box);
    struct brume_scene s = plain_scene();
    double sum = 0, worst = 0;
    look_along_x(&s, -6.5, 12, 12);
    s.step = BRUME_MIN_STEP;
    for (int i = 0; i < 64; i++) { /* opacity per sample 1e-6 to 1e-4 */
        s.density_scale = q32_of(16 * pow(10, -6 + 2 * i / 63.0));
        double exact = -expm1(-64 * scale_of(s.density_scale));
        double got = radiance(&a, &s);
        sum += got - exact;
        note(&worst, got, exact);
    }
    tap_check(fabs(sum / 64) < 0.25 * unit,
              "1024 faint samples, %s: mean error %.3f < 0.25 / 65536",
              format_name(format), fabs(sum / 64) / unit);
    check_worst("... and each", worst, precision);
    free(a.bytes);
}

/// Sun ///

/* What the lattice makes of the cube when the sun's transmittance at depth s
 * is exp(-sigma_l (near + slope s)): samples at depths (k + 1/2) step. */
struct lit_cube {
    double sigma_t, sigma_l, step;
    double near, slope;
};

static double lattice_radiance(const struct lit_cube *c)
{
    double sum = 0, opacity = -expm1(-c->sigma_t * c->step);
    for (double s = 0.5 * c->step; s < 16; s += c->step)
        sum += exp(-c->sigma_t * (s - 0.5 * c->step)) * opacity *
               exp(-c->sigma_l * (c->near + c->slope * s));
    return sum;
}

/* The integral over 0 <= s <= 16 of
 *     sigma_t exp(-sigma_t s) exp(-sigma_l (near + slope s)). */
static double integral_radiance(const struct lit_cube *c)
{
    double rate = c->sigma_t + c->slope * c->sigma_l;
    double path = rate == 0 ? 16 : -expm1(-16 * rate) / rate;
    return c->sigma_t * exp(-c->sigma_l * c->near) * path;
}

/* The eye 20.25 voxels before the face and steps of 1/2: faces half way
 * between samples, so that both ends of every axis are alike. The light's
 * quarter steps then never end on a face either. */
static void aim_at_cube(struct brume_scene *s, int view)
{
    double at[3];
    at[(view + 1) % 3] = 12; /* 4.5 and 11.5 voxels from the faces */
    at[(view + 2) % 3] = 14; /* 6.5 and 9.5 */
    at[view % 3] = view < 3 ? 7.5 - 20.25 : 23.5 + 20.25;
    set_eye(s, at[0], at[1], at[2]);
    look_along(s, view);
    s->step = 0x8000u;
    s->light = BRUME_UNIFORM;
    s->light_step = 0x4000u;
    s->light_samples = 100;
}

static struct lit_cube lit_cube_of(const struct brume_scene *s, int view,
                                   int sun)
{
    struct lit_cube c = {.sigma_t = scale_of(s->density_scale),
                         .sigma_l = scale_of(s->light_density_scale),
                         .step = ldexp(s->step, -16)};
    double at = ldexp(s->eye[sun % 3], -16);
    if (sun % 3 != view % 3)
        c.near = sun < 3 ? 23.5 - at : at - 7.5;
    else if (sun == view) /* behind the cube */
        c.near = 16, c.slope = -1;
    else /* behind the camera */
        c.slope = 1;
    return c;
}

/* The sun along every axis, seen along every axis: beside, above, below,
 * behind the cube and behind the camera. */
static void test_sun_axes(int format)
{
    struct asset a = cube_asset(format);
    struct brume_scene s = plain_scene();
    double worst = 0;
    for (int i = 0; i < 36 * 4; i++) {
        int view = i % 6, sun = i / 6 % 6;
        s.density_scale = q32_of(0.02 * pow(3, i / 36));
        s.light_density_scale = q32_of(0.15 / pow(2, i / 36));
        aim_at_cube(&s, view);
        set_sun(&s, sun);
        struct lit_cube c = lit_cube_of(&s, view, sun);
        note(&worst, radiance(&a, &s), lattice_radiance(&c));
    }
    char name[40];
    snprintf(name, sizeof name, "sun along any axis, %s", format_name(format));
    check_worst(name, worst, precision + sun_precision);
    free(a.bytes);
}

/* Steps halved from 2 to 1/8 approach the integral. Over a step the sun's
 * transmittance is within exp(sigma_l step / 2) of that in its middle, and so
 * is the radiance; and halving the step halves the error at least. */
static void check_convergence(const struct asset *a, int view, int sun)
{
    struct brume_scene s = plain_scene();
    bool bounded = true, shrinks = true;
    double last = 1, error = 0;
    s.density_scale = q32_of(0.08);
    s.light_density_scale = q32_of(0.15);
    set_sun(&s, sun);
    for (uint32_t step = 0x20000u; step >= 0x2000u; step /= 2) {
        aim_at_cube(&s, view);
        s.eye[view % 3] = BRUME_Q16(7.5) - (int32_t)(8 * step + step / 2);
        look_along(&s, view);
        s.step = step;
        s.light_step = step / 2;
        s.light_samples = 300;
        struct lit_cube c = lit_cube_of(&s, view, sun);
        double exact = integral_radiance(&c);
        double noise = precision + sun_precision;
        error = fabs(radiance(a, &s) - exact);
        bounded &= error <= exact * expm1(c.sigma_l * c.step / 2) + noise;
        shrinks &= error <= last / 2 + noise;
        last = error;
    }
    tap_check(bounded && shrinks,
              "sun %s: converges to single scattering, %.2f / 65536 at 1/8",
              sun == view ? "behind the slab" : "behind the camera",
              error / unit);
}

static void test_convergence(void)
{
    struct asset a = cube_asset(BRUME_U8);
    check_convergence(&a, 2, 2);
    check_convergence(&a, 2, 5);
    free(a.bytes);
}

/// Log light ///

/* A floor one voxel thick, that is seen, and a ceiling that shades it. They
 * fill the middle column of bricks, so that a range holds either 0 and 1 or
 * the ceiling alone, and every format is exact. */
struct floor_and_ceiling {
    int floor, low, high;
    uint32_t ceiling; /* density in 1/65280 */
};

static uint32_t floor_density(int x, int y, int z, const void *context)
{
    const struct floor_and_ceiling *c = context;
    if (x < 8 || x >= 16 || z < 8 || z >= 16)
        return 0;
    if (y == c->floor)
        return 65280;
    return y >= c->low && y < c->high ? c->ceiling : 0;
}

/* The sum of d s_k over s_k = light_step 2^k, straight up from the floor. */
static double log_sum(const struct floor_and_ceiling *c,
                      const struct brume_scene *s)
{
    double sum = 0, distance = ldexp(s->light_step, -16);
    for (int k = 0; k < s->light_samples; k++, distance *= 2) {
        double y = floor(c->floor + distance + 0.5);
        if (y == c->floor)
            sum += distance;
        else if (y >= c->low && y < c->high)
            sum += c->ceiling / 65280.0 * distance;
    }
    return sum;
}

static double log_light_error(const struct asset *a,
                              const struct floor_and_ceiling *c)
{
    static const double steps[] = {0.25, 0.5, 0.75, 1, 1.5, 2, 3, 5};
    struct brume_scene s = plain_scene();
    double worst = 0;
    look_along_x(&s, -4.5, c->floor, 12);
    s.light = BRUME_LOG;
    for (int i = 0; i < 8 * 17; i++) {
        s.light_step = (uint32_t)BRUME_Q16(steps[i % 8]);
        s.light_samples = (uint16_t)(i / 8);
        s.light_density_scale = q32_of(0.004 * (1 + i % 5));
        double tau = scale_of(s.light_density_scale) * log_sum(c, &s);
        note(&worst, radiance(a, &s), -expm1(-8) * exp(-tau));
    }
    return worst;
}

/* No sample or each may hit the ceiling, depending on the step; the weight is
 * the distance, not the thickness of anything. */
static void test_log_light(int format)
{
    const struct floor_and_ceiling c = {5, 8, 24, 100 * 256};
    struct asset_spec spec = asset_spec_of(3, 6, 3, format, floor_density, &c);
    struct asset a = asset_of(&spec);
    char name[48];
    snprintf(name, sizeof name, "log light, %s: exp(-sigma sum d s_k)",
             format_name(format));
    check_worst(name, log_light_error(&a, &c), precision + sun_precision);
    free(a.bytes);
}

/* Below a slab the weights are a geometric sum: all of n samples in it give
 * light_step (2^n - 1). */
static void test_log_geometric(void)
{
    const struct density_box box = {{4, 4, 4}, {20, 60, 20}, 65280};
    struct asset a = box_asset(3, 8, 3, BRUME_U8, box);
    struct brume_scene s = plain_scene();
    double worst = 0;
    look_along_x(&s, -4.5, 20, 12);
    s.light = BRUME_LOG;
    for (int n = 0; n <= 6; n++) {
        s.light_samples = (uint16_t)n;
        s.light_density_scale = q32_of(0.01);
        double sigma = scale_of(s.light_density_scale);
        /* 20 + 32 is the last in the box. */
        note(&worst, radiance(&a, &s),
             -expm1(-16) * exp(-sigma * ((1 << n) - 1)));
    }
    check_worst("log light in a slab: light_step (2^n - 1)", worst,
                precision + sun_precision);
    free(a.bytes);
}

/// Ball ///

#define BALL_RADIUS 20
#define BALL_PIXELS 96

static uint32_t ball_density(int x, int y, int z, const void *context)
{
    const int *centre = context;
    int dx = x - *centre, dy = y - *centre, dz = z - *centre;
    return dx * dx + dy * dy + dz * dz <= BALL_RADIUS * BALL_RADIUS ? 65280 : 0;
}

/* The way of a ray within a ball, passing its centre at distance b. */
static double chord(double radius, double b)
{
    return b < radius ? 2 * sqrt(radius * radius - b * b) : 0;
}

/* Distance from the axis of the ray of pixel (x, y), the ball's centre being
 * `far` away on the axis. */
static double ray_distance(const struct brume_scene *s, int x, int y,
                           double far)
{
    double pixel = 2 * tan(ldexp(s->fov, -17) * degree) / s->height;
    double u = (x + 0.5 - 0.5 * s->width) * pixel;
    double v = (0.5 * s->height - y - 0.5) * pixel;
    double slope = sqrt(u * u + v * v);
    return far * slope / sqrt(1 + slope * slope);
}

struct ball_count {
    int bad;                  /* pixels out of their bounds */
    double lit, inner, outer; /* pixels in the silhouette */
    double sum, exact;        /* of radiance */
};

/* A point of the voxelised ball is within sqrt(3)/2 of a centre that lies in
 * the ball; one that lies deeper than that is in it for sure. So along a ray
 * its chord is between those of two balls; sampling adds a step at most. */
static void count_ball_pixel(struct ball_count *c, const struct brume_scene *s,
                             double got, double b)
{
    double slack = sqrt(3) / 2, step = ldexp(s->step, -16);
    double sigma_t = scale_of(s->density_scale);
    double inner = chord(BALL_RADIUS - slack, b);
    double outer = chord(BALL_RADIUS + slack, b);
    double low = 1 - exp(-sigma_t * fmax(inner - step, 0));
    double high = outer > 0 ? 1 - exp(-sigma_t * (outer + step)) : 0;
    c->bad += !(got >= low - precision && got <= high + precision);
    c->lit += got > 0;
    c->inner += inner > step;
    c->outer += outer > 0;
    c->sum += got;
    c->exact += 1 - exp(-sigma_t * chord(BALL_RADIUS, b));
}

static void test_ball(int format)
{
    static uint16_t image[BALL_PIXELS * BALL_PIXELS];
    const int centre = 28;
    struct asset_spec spec =
        asset_spec_of(7, 7, 7, format, ball_density, &centre);
    struct asset a = asset_of(&spec);
    struct brume_scene s = plain_scene();
    struct ball_count c = {0};
    s.width = s.height = BALL_PIXELS;
    s.fov = 16u << 16;
    s.step = 0x4000u;
    s.density_scale = q32_of(0.05);
    set_eye(&s, centre, centre, centre + 180);
    look_along(&s, 5);
    if (!render(&a, &s, image))
        c.bad = 1;
    for (int i = 0; i < BALL_PIXELS * BALL_PIXELS; i++)
        count_ball_pixel(
            &c, &s, image[i] * unit,
            ray_distance(&s, i % BALL_PIXELS, i / BALL_PIXELS, 180));
    tap_check(c.bad == 0, "ball, %s: every chord (%d wrong)",
              format_name(format), c.bad);
    tap_check(c.lit >= c.inner && c.lit <= c.outer,
              "ball, %s: silhouette of %.0f pixels, %.0f .. %.0f",
              format_name(format), c.lit, c.inner, c.outer);
    /* Voxels stick out as often as they are cut off: there are 33401 of them,
     * 0.33 % less than 4/3 pi 20^3. Three times that, as here they count by
     * what is before them. */
    tap_check(fabs(c.sum / c.exact - 1) < 0.01,
              "ball, %s: total radiance to %.3f %% of 1 %%",
              format_name(format), 100 * fabs(c.sum / c.exact - 1));
    free(a.bytes);
}

/// Ramp ///

/* Rises by 4 codes of 255 a voxel from 0 at x = 8, to 128 at 40; then 0. */
static uint32_t ramp_density(int x, int y, int z, const void *context)
{
    (void)context;
    if (x <= 8 || x > 40 || y < 4 || y >= 20 || z < 4 || z >= 20)
        return 0;
    return (uint32_t)(x - 8) * 4 * 256;
}

static const double ramp_slope = 4.0 / 255;

/* Optical depth from x0 to the end, per density_scale: the straight line up
 * to 40, then the fall to 0 at 41. */
static double ramp_integral(double x0)
{
    double a = x0 - 8;
    return ramp_slope * ((32 * 32 - a * a) / 2 + 32 / 2.0);
}

/* The same of the staircase, where voxel x reaches from x - 1/2 to x + 1/2. */
static double ramp_stairs(double x0)
{
    double sum = 0;
    for (int x = 9; x <= 40; x++)
        sum += ramp_slope * (x - 8) * fmin(fmax(x + 0.5 - x0, 0), 1);
    return sum;
}

/* The lattice sum of a linear function is its integral plus half a step of
 * its first value (of the last, too, but that is 0): every knot is on it. */
static double ramp_sum(const struct brume_scene *s)
{
    double x0 = ldexp(s->eye[0], -16), step = ldexp(s->step, -16);
    if (s->filter == BRUME_NEAREST)
        return ramp_stairs(x0);
    return ramp_integral(fmax(x0, 8)) +
           (x0 > 8 ? step / 2 * ramp_slope * (x0 - 8) : 0);
}

/* From within the ramp, every quarter voxel, where nearest and trilinear
 * differ; and from before it. */
static void test_ramp(int format, bool apron)
{
    struct asset_spec spec = asset_spec_of(6, 3, 3, format, ramp_density, NULL);
    spec.apron = apron;
    struct asset a = asset_of(&spec);
    struct brume_scene s = plain_scene();
    double worst[2] = {0, 0};
    s.density_scale = q32_of(0.07);
    for (int i = 0; i < 2 * 3 * 159; i++) { /* to 40 */
        s.filter = i % 2 ? BRUME_TRILINEAR : BRUME_NEAREST;
        s.step = 0x4000u >> i / 2 % 3;
        look_along_x(&s, 0.5 + 0.25 * (i / 6), 12, 12);
        double depth = scale_of(s.density_scale) * ramp_sum(&s);
        note(&worst[i % 2], radiance(&a, &s), 1 - exp(-depth));
    }
    char name[64];
    for (int i = 0; i < 2; i++) {
        snprintf(name, sizeof name, "ramp, %s%s: %s", format_name(format),
                 apron ? " with apron" : "", i ? "line" : "stairs");
        /* u8r rounds to half a code: 15 units where a brick has a range of
         * 7 voxels' rise, 65 in the last. And d(1 - exp(-tau)) <= d tau. */
        double units = format == BRUME_U8 ? 0 : 31 * 15 + 65;
        check_worst(name, worst[i], precision + 0.07 * units / 65280);
    }
    free(a.bytes);
}

/// Nothing, and one voxel ///

static void test_empty(int format)
{
    static const uint32_t greys[] = {0, 1, 20000, 32768, 65535, 65536};
    const struct density_box box = {{0, 0, 0}, {0, 0, 0}, 0};
    struct asset a = box_asset(2, 2, 2, format, box);
    struct brume_scene s = plain_scene();
    uint16_t image[7 * 5];
    int wrong = 0;
    s.width = 7;
    s.height = 5;
    for (int i = 0; i < 6 * 6 * 2; i++) {
        s.background[0] = greys[i % 6];
        s.filter = i / 36 ? BRUME_TRILINEAR : BRUME_NEAREST;
        set_eye(&s, i & 1 ? 8 : -20, 7.5, 7.5);
        look_along(&s, i / 6 % 6);
        wrong += !render(&a, &s, image);
        for (int k = 0; k < 35; k++)
            wrong += image[k] != (greys[i % 6] < 65535 ? greys[i % 6] : 65535);
    }
    tap_check(wrong == 0, "empty, %s: the background to the bit",
              format_name(format));
    free(a.bytes);
}

static uint32_t voxel_density(int x, int y, int z, const void *context)
{
    const int *at = context;
    return x == at[0] && y == at[1] && z == at[2] ? 65280 : 0;
}

/* What a voxel's value weighs at an offset from its centre along an axis. */
static double weight_at(double offset, int filter)
{
    if (filter == BRUME_NEAREST)
        return offset < 0.5;
    return 1 - floor(256 * offset + 0.5) / 256;
}

/* The depth of one voxel along its axis: 1 times what the lookup weighs it by
 * beside the axis. Offsets are in 1/256, to which weights are rounded. */
static double voxel_error(const struct asset *a, const int at[3], int filter)
{
    static const double beside[] = {0, 51.3, 89.7, 127, 204.6};
    struct brume_scene s = plain_scene();
    double worst = 0;
    s.filter = (uint8_t)filter;
    for (int i = 0; i < 6 * 25; i++) {
        int view = i % 6, axis = view % 3;
        double p[3] = {at[0], at[1], at[2]}, dy = beside[i / 6 % 5] / 256;
        double dz = beside[i / 30] / 256;
        p[axis] += view < 3 ? -20.5 : 20.5;
        p[(axis + 1) % 3] += dy;
        p[(axis + 2) % 3] -= dz;
        set_eye(&s, p[0], p[1], p[2]);
        look_along(&s, view);
        s.step = 0x8000u >> i % 4;
        double weight = weight_at(dy, filter) * weight_at(dz, filter);
        note(&worst, radiance(a, &s), 1 - exp(-weight));
    }
    return worst;
}

/* In the middle of a brick, and at the corner of eight. */
static void test_one_voxel(int format, bool apron)
{
    static const int places[2][3] = {{12, 11, 13}, {15, 8, 16}};
    char name[64];
    for (int i = 0; i < 2; i++) {
        struct asset_spec spec =
            asset_spec_of(3, 3, 3, format, voxel_density, places[i]);
        spec.apron = apron;
        struct asset a = asset_of(&spec);
        snprintf(name, sizeof name, "one voxel, %s%s: chord",
                 format_name(format), apron ? " with apron" : "");
        check_worst(name, voxel_error(&a, places[i], BRUME_NEAREST), precision);
        snprintf(name, sizeof name, "one voxel, %s%s: tent",
                 format_name(format), apron ? " with apron" : "");
        /* A mean is rounded to 1/65280; in u4r to 1/256 of a code, of which
         * 15 are 1. Samples of half of that, over 2 voxels. */
        check_worst(name, voxel_error(&a, places[i], BRUME_TRILINEAR),
                    precision + 1.0 / (format == BRUME_U4R ? 15 * 256 : 65280));
        free(a.bytes);
    }
}

/// Projection ///

static void cross3(double out[3], const double a[3], const double b[3])
{
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = a[j] * b[k] - a[k] * b[j];
    }
}

static void unit3(double v[3])
{
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++)
        v[i] /= length;
}

/* Direction of a pixel's ray, of a pinhole camera in double. */
static void pixel_ray(double out[3], const struct brume_scene *s, double x,
                      double y)
{
    double ahead[3], right[3], up[3];
    for (int i = 0; i < 3; i++) {
        ahead[i] = ldexp((double)s->target[i] - s->eye[i], -16);
        up[i] = s->up[i];
    }
    unit3(ahead);
    cross3(right, ahead, up);
    unit3(right);
    cross3(up, right, ahead);
    double half = tan(ldexp(s->fov, -17) * degree);
    double u = (2 * x + 1 - s->width) / s->height * half;
    double v = (s->height - 2 * y - 1) / s->height * half;
    for (int i = 0; i < 3; i++)
        out[i] = ahead[i] + u * right[i] + v * up[i];
    unit3(out);
}

/* The way of the ray within the cube of one voxel, grown by `grow`. */
static double way_in_voxel(const struct brume_scene *s, const double ray[3],
                           const int at[3], double grow)
{
    double in = 0, out = 1e9;
    for (int i = 0; i < 3; i++) {
        double eye = ldexp(s->eye[i], -16);
        double a = (at[i] - 0.5 - grow - eye) / ray[i];
        double b = (at[i] + 0.5 + grow - eye) / ray[i];
        in = fmax(in, fmin(a, b));
        out = fmin(out, fmax(a, b));
    }
    return fmax(out - in, 0);
}

struct footprint {
    int wrong, lit;
    double x, y; /* mean of the lit pixels, from the middle */
};

/* Each pixel whose ray crosses the voxel over more than a step is lit, and
 * none whose ray misses it. Positions are rounded to 2^-16 and directions to
 * 2^-26: less than 2^-10 voxel at the distances here, under 100. */
static struct footprint footprint_of(const struct asset *a,
                                     const struct brume_scene *s,
                                     const int at[3])
{
    static uint16_t image[160 * 160];
    const double fuzz = ldexp(1, -10);
    struct footprint f = {!render(a, s, image), 0, 0, 0};
    for (int i = 0; i < s->width * s->height; i++) {
        int x = i % s->width, y = i / s->width;
        double ray[3];
        pixel_ray(ray, s, x, y);
        bool lit = image[i] > 0;
        f.wrong +=
            !lit && way_in_voxel(s, ray, at, -fuzz) > ldexp(s->step, -16);
        f.wrong += lit && way_in_voxel(s, ray, at, fuzz) == 0;
        f.lit += lit;
        f.x += lit * (x + 0.5 - 0.5 * s->width);
        f.y += lit * (0.5 * s->height - y - 0.5);
    }
    return f;
}

static struct brume_scene projection_scene(int width, int height, double fov)
{
    struct brume_scene s = plain_scene();
    s.width = (uint16_t)width;
    s.height = (uint16_t)height;
    s.fov = (uint32_t)BRUME_Q16(fov);
    s.step = BRUME_MIN_STEP;
    s.density_scale = (uint64_t)1 << 42; /* one sample is opaque */
    return s;
}

/* Looking along -z, +x is right and +y is up. */
static void test_orientation(void)
{
    static const struct {
        int width, height;
        double fov, far;
    } views[] = {{64, 64, 40, 30},
                 {150, 40, 60, 16},
                 {40, 150, 25, 40},
                 {128, 96, 110, 12},
                 {33, 77, 1, 60}};
    const int at[3] = {13, 14, 12};
    struct asset_spec spec =
        asset_spec_of(3, 3, 3, BRUME_U8, voxel_density, at);
    struct asset a = asset_of(&spec);
    for (int i = 0; i < 5; i++) {
        double fov = views[i].fov, far = views[i].far;
        struct brume_scene s =
            projection_scene(views[i].width, views[i].height, fov);
        double off = fov < 2 ? 0.6 : 1.5;
        set_eye(&s, at[0] - off, at[1] - 1.5 * off, at[2] + far);
        look_along(&s, 5);
        s.up[0] = 0, s.up[1] = 7;
        struct footprint f = footprint_of(&a, &s, at);
        tap_check(f.wrong == 0 && f.lit > 0 && f.x > 0 && f.y > f.x,
                  "%dx%d, %g degrees: +x is right, +y up; %d pixels, %d wrong",
                  s.width, s.height, fov, f.lit, f.wrong);
    }
    free(a.bytes);
}

static void test_random_cameras(void)
{
    const int at[3] = {12, 11, 13};
    struct asset_spec spec =
        asset_spec_of(3, 3, 3, BRUME_U8R, voxel_density, at);
    struct asset a = asset_of(&spec);
    int wrong = 0, lit = 0;
    for (int i = 0; i < 40; i++) {
        struct brume_scene s =
            projection_scene(24 + i, 64 - i, random_between(10, 60));
        for (int k = 0; k < 3; k++) {
            int32_t p = at[k] * 65536;
            s.eye[k] = p + BRUME_Q16(random_between(-20, 20));
            s.target[k] = p + BRUME_Q16(random_between(-1, 1));
            s.up[k] = BRUME_Q16(random_between(-9, 9));
        }
        struct footprint f = footprint_of(&a, &s, at);
        wrong += f.wrong;
        lit += f.lit;
    }
    tap_check(wrong == 0 && lit > 1000,
              "40 cameras: the voxel's projection; %d pixels, %d wrong", lit,
              wrong);
    free(a.bytes);
}

/// Camera in and on the block ///

/* The first sample is at the eye, and stands for a step: with the exit half
 * way between two samples, n of them, n - 1/2 steps away. */
static void test_inside(int format)
{
    struct asset a = cube_asset(format);
    struct brume_scene s = plain_scene();
    double worst = 0;
    s.density_scale = q32_of(0.1);
    for (int i = 0; i < 6 * 14; i++) {
        int view = i % 6, n = 1 + i / 6;
        double p[3] = {15, 12, 18}, way = n - 0.5;
        p[view % 3] = view < 3 ? 23.5 - way : 7.5 + way;
        set_eye(&s, p[0], p[1], p[2]);
        look_along(&s, view);
        double depth = scale_of(s.density_scale) * n;
        note(&worst, radiance(&a, &s), 1 - exp(-depth));
    }
    check_worst("eye inside, along the axes", worst, precision);
    free(a.bytes);
}

/* Aslant the exit is anywhere between two samples: off by less than a step,
 * here 1/16 voxel, which changes the radiance by T sigma_t step. */
static void test_inside_aslant(void)
{
    struct asset a = cube_asset(BRUME_U8);
    struct brume_scene s = plain_scene();
    int wrong = 0;
    s.density_scale = q32_of(0.1);
    s.step = BRUME_MIN_STEP;
    for (int i = 0; i < 200; i++) {
        double ray[3], exit = 1e9;
        for (int k = 0; k < 3; k++) {
            s.eye[k] = BRUME_Q16(random_between(8, 23));
            s.target[k] = BRUME_Q16(random_between(8, 23));
        }
        pixel_ray(ray, &s, 0, 0);
        for (int k = 0; k < 3; k++) {
            double face = ray[k] > 0 ? 23.5 : 7.5;
            exit = fmin(exit, (face - ldexp(s.eye[k], -16)) / ray[k]);
        }
        double sigma_t = scale_of(s.density_scale), got = radiance(&a, &s);
        wrong += !(got >= 1 - exp(-sigma_t * exit) - precision);
        wrong += !(got <= 1 - exp(-sigma_t * (exit + 0.0625)) + precision);
    }
    tap_check(wrong == 0, "eye inside, aslant: the way to the exit (%d wrong)",
              wrong);
    free(a.bytes);
}

/* A face at 7.5 belongs to the block, one at 23.5 does not; and 2^-16 voxel
 * decides. Looking along them, there is the whole block or none. */
static void test_grazing(int format)
{
    static const struct {
        double at;
        bool block;
    } faces[] = {{7.5, true},
                 {7.5 - 1 / 65536.0, false},
                 {23.5, false},
                 {23.5 - 1 / 65536.0, true}};
    struct asset a = cube_asset(format);
    struct brume_scene s = plain_scene();
    double worst = 0;
    s.background[0] = 0x4000u;
    s.density_scale = q32_of(0.05);
    double t = exp(-16 * scale_of(s.density_scale));
    for (int i = 0; i < 6 * 2 * 4; i++) {
        int view = i % 6, beside = (view + 1 + i / 6 % 2) % 3;
        double p[3] = {16, 16, 16};
        p[view % 3] = view < 3 ? 7.5 - 12 : 23.5 + 12;
        p[beside] = faces[i / 12].at;
        set_eye(&s, p[0], p[1], p[2]);
        look_along(&s, view);
        note(&worst, radiance(&a, &s),
             faces[i / 12].block ? 1 - t + 0.25 * t : 0.25);
    }
    check_worst("eye on a face, nearest: block or background", worst,
                precision);
    free(a.bytes);
}

/* Half way between full and empty voxels a trilinear lookup finds 1/2. */
static void test_grazing_trilinear(int format)
{
    struct asset a = cube_asset(format);
    struct brume_scene s = plain_scene();
    double worst = 0;
    s.filter = BRUME_TRILINEAR;
    s.density_scale = q32_of(0.05);
    for (int i = 0; i < 6 * 7; i++) {
        /* 7, 7.5 and 8: 0, 1/2 and 1; 16: 1; 23, 23.5, 24: 1, 1/2, 0 */
        static const double at[] = {7, 7.5, 8, 16, 23, 23.5, 24};
        static const double density[] = {0, 0.5, 1, 1, 1, 0.5, 0};
        double p[3] = {16, 16, 16};
        int view = i % 6;
        p[view % 3] = view < 3 ? -12 : 44;
        p[(view + 1) % 3] = at[i / 6];
        set_eye(&s, p[0], p[1], p[2]);
        look_along(&s, view);
        double depth = 16 * scale_of(s.density_scale) * density[i / 6];
        note(&worst, radiance(&a, &s), 1 - exp(-depth));
    }
    /* A mean of u8r or u4r codes is rounded to 1/65280: of the depth, 0.8 */
    check_worst("eye on a face, trilinear: half the density", worst, precision);
    free(a.bytes);
}

/* A full pool, its own faces and edges, all directions: inside or not, in
 * bounds. Sanitizers see the rest. */
static void test_grazing_pool(void)
{
    const struct density_box box = {{0, 0, 0}, {16, 16, 16}, 65280};
    static const double at[] = {-1, -0.5, 0, 7.5, 14.5, 15, 15.5, 16};
    struct asset a = box_asset(2, 2, 2, BRUME_U8, box);
    struct brume_scene s = plain_scene();
    uint16_t image[9];
    int wrong = 0;
    s.width = s.height = 3;
    s.density_scale = (uint64_t)1 << 42;
    for (int i = 0; i < 512 * 6 * 2; i++) {
        int e = i % 512, view = i / 512 % 6;
        double p[3] = {at[e % 8], at[e / 8 % 8], at[e / 64]};
        s.filter = i / 3072 ? BRUME_TRILINEAR : BRUME_NEAREST;
        set_eye(&s, p[0], p[1], p[2]);
        look_along(&s, view);
        wrong += !render(&a, &s, image);
        bool in = true;
        for (int k = 0; k < 3; k++)
            in = in && p[k] >= -0.5 && p[k] < 15.5;
        if (s.filter == BRUME_NEAREST && in)
            wrong += image[4] < 65535;
    }
    tap_check(wrong == 0, "eye on the pool's faces and edges (%d wrong)",
              wrong);
    free(a.bytes);
}

/// Steps ///

/* 32 voxels with faces on the lattice of every step. */
static struct asset long_block(int format)
{
    const struct density_box box = {{16, 4, 4}, {48, 20, 20}, 65280};
    return box_asset(8, 3, 3, format, box);
}

/* Errors from the closed form of steps 1/4 to 16, both ways along x, and how
 * far they are apart; `sun` is the sun's transmittance, constant. */
static void step_errors(const struct asset *a, struct brume_scene *s,
                        double sun, double *worst, double *apart)
{
    double low = 2, high = -1;
    double depth = 32 * scale_of(s->density_scale);
    for (int i = 0; i < 14; i++) {
        set_eye(s, i % 2 ? 47.5 + 16 : 15.5 - 16, 12, 12);
        look_along(s, i % 2 ? 3 : 0);
        s->step = 0x4000u << i / 2;
        double got = radiance(a, s);
        note(worst, got, (1 - exp(-depth)) * sun);
        low = fmin(low, got);
        high = fmax(high, got);
    }
    *apart = fmax(*apart, high - low);
}

static void check_steps(const char *name, double worst, double apart,
                        double bound)
{
    tap_check(worst <= bound && apart <= 1.0 / 255,
              "steps 1/4 to 16, %s: apart %.4f <= 1 / 255; error %.2f <= %.2f"
              " / 65536",
              name, 255 * apart, worst / unit, bound / unit);
}

/* Also in trilinear lookup: the faces are samples of half the density. */
static void test_steps(int format, int filter)
{
    struct asset a = long_block(format);
    struct brume_scene s = plain_scene();
    double worst = 0, apart = 0;
    s.filter = (uint8_t)filter;
    for (int i = 0; i < 12; i++) {
        s.density_scale = q32_of(0.001 * pow(2, i));
        step_errors(&a, &s, 1, &worst, &apart);
    }
    check_steps(filter == BRUME_NEAREST ? "nearest" : "trilinear", worst, apart,
                precision);
    free(a.bytes);
}

/* The sun straight above: the way to it is 7.5 voxels from anywhere on the
 * ray. `log` has its samples at 1, 2 and 4 in the block: 7 voxels. Not in
 * trilinear lookup, where the sun shines brighter in the half-dense faces. */
static void test_steps_lit(void)
{
    struct asset a = long_block(BRUME_U8);
    struct brume_scene s = plain_scene();
    for (int light = BRUME_LOG; light <= BRUME_UNIFORM; light++) {
        double worst = 0, apart = 0;
        double way = light == BRUME_LOG ? 7 : 7.5;
        s.light = (uint8_t)light;
        s.light_step = light == BRUME_LOG ? 0x10000u : 0x8000u;
        s.light_samples = light == BRUME_LOG ? 8 : 64;
        for (int i = 0; i < 12; i++) {
            s.density_scale = q32_of(0.001 * pow(2, i));
            s.light_density_scale = q32_of(0.03 * (i % 4));
            double sun = exp(-way * scale_of(s.light_density_scale));
            step_errors(&a, &s, sun, &worst, &apart);
        }
        check_steps(light == BRUME_LOG ? "log light" : "uniform light", worst,
                    apart, precision + sun_precision);
    }
    free(a.bytes);
}

/* Jitter moves the samples but not their number. */
static void test_steps_jittered(void)
{
    struct asset a = long_block(BRUME_U8);
    struct brume_scene s = plain_scene();
    double worst = 0, apart = 0;
    s.density_scale = q32_of(0.05);
    s.jitter = BRUME_JITTER_BOTH;
    for (int i = 0; i < 96; i++) {
        s.noise = (uint8_t)(BRUME_NOISE_WHITE + i % 3);
        s.frame = (uint32_t)i;
        step_errors(&a, &s, 1, &worst, &apart);
    }
    check_steps("jittered", worst, apart, precision);
    free(a.bytes);
}

/// Thresholds ///

/* The ray ends after the first sample that leaves less than the threshold,
 * and the background shines through what is left. */
static void test_min_transmittance(void)
{
    static const double thresholds[] = {1, 0.7, 0.5, 0.3, 0.1, 0.05, 0.03};
    struct asset a = long_block(BRUME_U8);
    struct brume_scene s = plain_scene();
    double worst = 0;
    look_along_x(&s, -0.5, 12, 12);
    s.background[0] = 0x8000u;
    for (int i = 0; i < 7 * 4; i++) {
        s.density_scale = q32_of(0.1731 / (1 << i / 7));
        s.step = 0x10000u;
        s.min_transmittance = (uint32_t)BRUME_Q16(thresholds[i % 7]);
        double per_sample = scale_of(s.density_scale), t = 1;
        for (int k = 0; k < 32; k++) {
            t = exp(-per_sample * (k + 1));
            if (t < s.min_transmittance * unit)
                break;
        }
        note(&worst, radiance(&a, &s), 1 - t + 0.5 * t);
    }
    check_worst("min_transmittance: the sample that ends the ray", worst,
                precision);
    free(a.bytes);
}

/* A box in a volume of another density_max. Where that is 255, density c is
 * code c of u8, and a Q32.32 number; a box of whole bricks is exact in the
 * other formats, too. */
static struct asset graded_asset(int format, uint32_t max_m, int32_t max_e,
                                 const struct density_box *box)
{
    struct asset_spec spec =
        asset_spec_of(3, 3, 3, format, density_in_box, box);
    spec.max_m = max_m;
    spec.max_e = max_e;
    return asset_of(&spec);
}

/* Errors of a box of density c when min_density is c, and just beside: at
 * half a code of 1/65280. In u8 the code below and above is a whole one off,
 * so that this tells no less. */
static int threshold_errors(const struct asset *a, int c, int filter)
{
    struct brume_scene s = plain_scene();
    int wrong = 0;
    look_along_x(&s, -4.5, 12, 12);
    s.filter = (uint8_t)filter;
    s.density_scale = (uint64_t)1 << 42;
    s.min_density = (uint64_t)c << 32;
    wrong += radiance(a, &s) != 0; /* only what is above counts */
    s.min_density = q32_of(c - 0.5 / 256);
    wrong += radiance(a, &s) < 0.99;
    s.min_density = q32_of(c + 0.5 / 256);
    wrong += radiance(a, &s) != 0;
    return wrong;
}

static void test_min_density(int format, int filter)
{
    int wrong = 0, first = 0;
    for (int c = 1; c <= 255; c++) {
        const struct density_box box = {
            {8, 8, 8}, {16, 16, 16}, (uint32_t)c * 256};
        struct asset a = graded_asset(format, 255u << 24, -24, &box);
        int n = threshold_errors(&a, c, filter);
        if (n > 0 && wrong == 0)
            first = c;
        wrong += n;
        free(a.bytes);
    }
    tap_check(wrong == 0,
              "min_density at, below and above each code, %s %s "
              "(%d wrong, first at %d)",
              format_name(format), filter ? "trilinear" : "nearest", wrong,
              first);
}

/* A threshold at density_max leaves nothing, whatever density_max is; half a
 * unit of 1/65280 lower it leaves all. */
static void test_min_density_of_max(int format)
{
    const struct density_box box = {{4, 4, 4}, {20, 20, 20}, 65280};
    int wrong = 0;
    for (int i = 0; i < 200; i++) {
        /* m 2^e is a Q32.32 number for e >= -32. */
        uint32_t m = i < 32 ? 0x80000000u : random_word() | 0x80000000u;
        int32_t e = i % 32 - 32;
        struct asset a = graded_asset(format, m, e, &box);
        struct brume_scene s = plain_scene();
        look_along_x(&s, -4.5, 12, 12);
        s.density_scale = UINT64_MAX;
        s.min_density = (uint64_t)m << (e + 32);
        wrong += radiance(&a, &s) != 0;
        s.min_density -= s.min_density / (2 * 65280);
        wrong += !(radiance(&a, &s) > 0.5);
        free(a.bytes);
    }
    tap_check(wrong == 0, "min_density at density_max and below, %s (%d wrong)",
              format_name(format), wrong);
}

/* The clamp is put in codes of 1/65280 of density_max, rounded down. */
static void test_max_density(int format)
{
    const struct density_box box = {{8, 8, 8}, {16, 16, 16}, 200 * 256};
    struct asset a = graded_asset(format, 255u << 24, -24, &box);
    struct brume_scene s = plain_scene();
    double worst = 0;
    look_along_x(&s, -4.5, 12, 12);
    s.density_scale = q32_of(0.0014);
    for (int i = 0; i < 2 * 300; i++) {
        double most = i / 2 * 0.99;
        s.max_density = q32_of(most); /* 0: no clamp */
        s.filter = i % 2 ? BRUME_TRILINEAR : BRUME_NEAREST;
        double density = most > 0 ? fmin(most, 200) : 200;
        double depth = 8 * scale_of(s.density_scale) * density;
        note(&worst, radiance(&a, &s), 1 - exp(-depth));
    }
    char name[40];
    snprintf(name, sizeof name, "max_density, %s: min(d, max)",
             format_name(format));
    check_worst(name, worst, precision + 8 * 0.0014 / 256);
    free(a.bytes);
}

/* L is proportional to the albedo, T does not change. */
static void test_albedo_and_background(void)
{
    static const double shares[] = {0, 0.25, 0.5, 1};
    struct asset a = cube_asset(BRUME_U8);
    struct brume_scene s = plain_scene();
    double worst = 0;
    look_along_x(&s, -8.5, 16, 16);
    for (int i = 0; i < 4 * 4 * 10; i++) {
        double albedo = shares[i % 4], background = shares[i / 4 % 4];
        s.albedo = (uint32_t)BRUME_Q16(albedo);
        s.background[0] = (uint32_t)BRUME_Q16(background);
        s.density_scale = q32_of(0.002 * (1 << i / 16));
        double t = exp(-16 * scale_of(s.density_scale));
        note(&worst, radiance(&a, &s), albedo * (1 - t) + background * t);
    }
    /* Two roundings here: of L, and of T times the background. */
    check_worst("albedo (1 - T) + background T", worst, precision + 0.5 * unit);
    free(a.bytes);
}

/// Extremes ///

/* density_max = 2^e, seen through scales of 2^-32 to 2^31: the radiance is
 * right whatever their product. */
static double extreme_error(int format, int32_t e, bool of_light)
{
    const struct density_box box = {{4, 4, 4}, {20, 20, 20}, 65280};
    struct asset_spec spec =
        asset_spec_of(3, 3, 3, format, density_in_box, &box);
    spec.max_e = e - 31;
    struct asset a = asset_of(&spec);
    struct brume_scene s = plain_scene();
    double worst = 0;
    look_along_x(&s, -4.5, 12, 12);
    s.background[0] = 0x8000u;
    s.light = of_light ? BRUME_UNIFORM : BRUME_NO_LIGHT;
    s.light_step = 0x8000u; /* 7.5 voxels to the top: 15 samples */
    s.light_samples = 64;
    for (int k = 0; k <= 65; k++) {
        uint64_t q = k == 65 ? UINT64_MAX : k == 64 ? 0 : (uint64_t)1 << k;
        s.density_scale = of_light ? UINT64_MAX : q;
        s.light_density_scale = q;
        double t = exp(-16 * ldexp(scale_of(s.density_scale), e));
        double sun = of_light ? exp(-7.5 * ldexp(scale_of(q), e)) : 1;
        note(&worst, radiance(&a, &s), (1 - t) * sun + 0.5 * t);
    }
    free(a.bytes);
    return worst;
}

static void test_extremes(int format)
{
    static const int32_t exponents[] = {-993, -300, -40, -8,  0,
                                        8,    40,   300, 1022};
    double view = 0, light = 0;
    for (int i = 0; i < 9; i++) {
        view = fmax(view, extreme_error(format, exponents[i], false));
        light = fmax(light, extreme_error(format, exponents[i], true));
    }
    char name[64];
    snprintf(name, sizeof name, "density_scale 0 to 2^32, %s",
             format_name(format));
    check_worst(name, view, precision + 0.5 * unit);
    snprintf(name, sizeof name, "light_density_scale 0 to 2^32, %s",
             format_name(format));
    check_worst(name, light, precision + sun_precision + 0.5 * unit);
}

int main(void)
{
    for (int format = BRUME_U8; format <= BRUME_U4R; format++) {
        test_slab(format);
        test_faint_rays(format);
        test_sun_axes(format);
        test_ball(format);
        test_empty(format);
        test_one_voxel(format, false);
        test_one_voxel(format, true);
        test_inside(format);
        test_grazing(format);
        test_grazing_trilinear(format);
        test_steps(format, BRUME_NEAREST);
        test_steps(format, BRUME_TRILINEAR);
        test_log_light(format);
        test_min_density(format, BRUME_NEAREST);
        test_min_density(format, BRUME_TRILINEAR);
        test_min_density_of_max(format);
        test_max_density(format);
        test_extremes(format);
    }
    test_convergence();
    test_log_geometric();
    for (int i = 0; i < 4; i++)
        test_ramp(i % 2 ? BRUME_U8R : BRUME_U8, i / 2);
    test_orientation();
    test_random_cameras();
    test_inside_aslant();
    test_grazing_pool();
    test_steps_lit();
    test_steps_jittered();
    test_min_transmittance();
    test_albedo_and_background();
    return tap_done();
}
