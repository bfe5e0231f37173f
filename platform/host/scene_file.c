/* SPDX-License-Identifier: MIT */
#include "scene_file.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noises.h"

#define FAR 1e9 /* world coordinates; the pool's own limit comes later */
#define MAX_Q32 4294967295.0 /* whole part of the core's Q32.32 */

/// Keys ///

enum kind { NUMBER, INTEGER, VECTOR, ANGLES, SIZE, COLOUR, WORD };

struct key {
    const char *name;
    enum kind kind;
    double min, max;     /* of each component */
    const char *words;   /* WORD: the values 0, 1, 2... */
    const char *meaning; /* for --help, with the default */
};

static const struct key k_keys[SCENE_KEYS] = {
    {"size", SIZE, 1, BRUME_MAX_SIZE, NULL, "WxH pixels (640x480)"},
    {"eye", VECTOR, -FAR, FAR, NULL, "world position (in front of the box)"},
    {"target", VECTOR, -FAR, FAR, NULL, "world position (middle of the box)"},
    {"up", VECTOR, -FAR, FAR, NULL, "direction (0,1,0)"},
    {"fov", NUMBER, 1, 160, NULL, "vertical, degrees (40)"},
    {"sun", ANGLES, -3600, 3600, NULL,
     "azimuth elevation, degrees, towards the sun (-60 30)"},
    {"density_scale", NUMBER, 0, MAX_Q32, NULL,
     "extinction per voxel per density, view rays (from the mean density)"},
    {"light_density_scale", NUMBER, 0, MAX_Q32, NULL,
     "the same on light rays (from the mean density)"},
    {"albedo", NUMBER, 0, 1, NULL, "(1)"},
    {"step", NUMBER, 0.0625, 256, NULL, "voxels between samples (1 to 4)"},
    {"min_density", NUMBER, 0, 1e9, NULL, "samples not above count for 0 (0)"},
    {"min_transmittance", NUMBER, 0, 1, NULL, "ends a ray below it (0.01)"},
    {"max_density", NUMBER, 0, 1e9, NULL, "clamps voxels (0: no clamp)"},
    {"filter", WORD, 0, 0, "nearest trilinear", "(trilinear)"},
    {"light", WORD, 0, 0, "log uniform none", "(uniform)"},
    {"light_samples", INTEGER, 0, BRUME_MAX_UNIFORM_SAMPLES, NULL,
     "per lit sample; log: at most 16 (64; log: to cross the box)"},
    {"light_step", NUMBER, 0.0625, 256, NULL,
     "voxels; log doubles it (1/64 of the box; log: 1)"},
    {"jitter", WORD, 0, 0, "none primary light both",
     "which rays are jittered (primary)"},
    {"noise", WORD, 0, 0, noise_words,
     "or NAME.WxHxT.raw: of the jitter (ign)"},
    {"frame", INTEGER, 0, UINT32_MAX, NULL, "moves the noise (0)"},
    {"background", COLOUR, 0, 1, NULL, "linear grey or r,g,b (0.12,0.25,0.5)"},
    {"output", WORD, 0, 0, "linear srgb", "mapping to 0..255 (srgb)"},
    {"skip", WORD, 0, 0, "off on", "leap over empty cells (on)"},
};

void scene_print_keys(FILE *to)
{
    for (int i = 0; i < SCENE_KEYS; i++) {
        const struct key *k = &k_keys[i];
        fprintf(to, "  %-20s %s%s%s", k->name, k->words ? k->words : "",
                k->words ? " " : "", k->meaning);
        if (k->kind == NUMBER || k->kind == INTEGER)
            fprintf(to, ", %g to %g", k->min, k->max);
        fputc('\n', to);
    }
}

/// Parsing ///

/* A decimal number, and *text moves past it. strtod by itself would also take
 * hexadecimal, "inf" and "nan". */
static bool read_number(const char **text, double *out)
{
    char digits[64], *end;
    size_t n = strspn(*text, "+-.0123456789eE");
    if (n == 0 || n >= sizeof digits)
        return false;
    memcpy(digits, *text, n);
    digits[n] = '\0';
    *text += n;
    *out = strtod(digits, &end);
    return end != digits && *end == '\0' && isfinite(*out);
}

/* Up to three numbers separated by commas, spaces or `also`; how many there
 * were, or -1 on anything else. */
static int read_numbers(const char *text, double out[3], char also)
{
    int n = 0;
    for (;;) {
        text += strspn(text, " \t");
        if (*text == '\0')
            return n;
        if (n == 3 || !read_number(&text, &out[n]))
            return -1;
        n++;
        text += strspn(text, " \t");
        if (*text == ',' || (also && *text == also)) {
            if (*++text == '\0')
                return -1;
        }
    }
}

static int word_index(const char *words, const char *word)
{
    size_t n = strlen(word);
    for (int i = 0; *words; i++) {
        size_t len = strcspn(words, " ");
        if (len == n && strncmp(words, word, n) == 0)
            return i;
        words += len;
        words += strspn(words, " ");
    }
    return -1;
}

static const char *wanted(enum kind kind)
{
    switch (kind) {
    case VECTOR: return "three numbers x,y,z";
    case ANGLES: return "two numbers, azimuth elevation";
    case SIZE: return "two whole numbers WxH";
    case COLOUR: return "one number, or three r,g,b";
    case INTEGER: return "a whole number";
    default: return "a number";
    }
}

static bool count_is_right(enum kind kind, int n)
{
    switch (kind) {
    case VECTOR: return n == 3;
    case ANGLES:
    case SIZE: return n == 2;
    case COLOUR: return n == 1 || n == 3;
    default: return n == 1;
    }
}

static int read_value(const struct key *k, const char *text, double out[3],
                      const char *where, char *err, size_t err_size)
{
    if (k->kind == WORD) {
        int word = word_index(k->words, text);
        if (word < 0) {
            snprintf(err, err_size, "%s: %s is one of %s, not '%.40s'", where,
                     k->name, k->words, text);
            return -1;
        }
        out[0] = word;
        return 0;
    }
    int n = read_numbers(text, out, k->kind == SIZE ? 'x' : '\0');
    bool whole = k->kind == INTEGER || k->kind == SIZE;
    bool good = count_is_right(k->kind, n);
    for (int i = 0; good && i < n; i++)
        good = !whole || out[i] == floor(out[i]);
    if (!good) {
        snprintf(err, err_size, "%s: %s is %s, not '%.40s'", where, k->name,
                 wanted(k->kind), text);
        return -1;
    }
    for (int i = 0; i < n; i++)
        if (out[i] < k->min || out[i] > k->max) {
            snprintf(err, err_size, "%s: %s is %g, outside %g to %g", where,
                     k->name, out[i], k->min, k->max);
            return -1;
        }
    if (k->kind == COLOUR && n == 1)
        out[1] = out[2] = out[0];
    return 0;
}

/* Cuts spaces off both ends, in place. */
static char *trimmed(char *s)
{
    while (isspace((unsigned char)*s))
        s++;
    size_t n = strlen(s);
    while (n > 0 && isspace((unsigned char)s[n - 1]))
        s[--n] = '\0';
    return s;
}

/* Short enough, and nothing in it that would upset a terminal. */
static int check_text(const char *text, const char *where, char *err,
                      size_t err_size)
{
    if (strlen(text) >= SCENE_LINE_SIZE) {
        snprintf(err, err_size, "%s: line of more than %d bytes", where,
                 SCENE_LINE_SIZE - 1);
        return -1;
    }
    for (; *text; text++)
        if (iscntrl((unsigned char)*text) && *text != '\t') {
            snprintf(err, err_size, "%s: control character in the line", where);
            return -1;
        }
    return 0;
}

/* A noise that is a file is read at once, so that what is wrong with it has
 * its line. */
static int read_noise(struct scene_settings *settings, const char *path,
                      const char *where, char *err, size_t err_size)
{
    char reason[SCENE_LINE_SIZE];
    settings->noise_file =
        noise_is_file(path) ? noise_read(path, reason, sizeof reason) : NULL;
    if (noise_is_file(path) && settings->noise_file == NULL) {
        snprintf(err, err_size, "%s: %s", where, reason);
        return -1;
    }
    return 0;
}

int scene_set(struct scene_settings *settings, const char *text,
              const char *where, char *err, size_t err_size)
{
    char line[SCENE_LINE_SIZE];
    if (check_text(text, where, err, err_size) != 0)
        return -1;
    strcpy(line, text);
    char *equals = strchr(line, '=');
    if (equals == NULL) {
        snprintf(err, err_size, "%s: no '=' in '%.40s'", where, text);
        return -1;
    }
    *equals = '\0';
    const char *name = trimmed(line), *value = trimmed(equals + 1);
    for (int i = 0; i < SCENE_KEYS; i++) {
        if (strcmp(k_keys[i].name, name) != 0)
            continue;
        if (i == SCENE_NOISE &&
            read_noise(settings, value, where, err, err_size) != 0)
            return -1;
        if ((i != SCENE_NOISE || settings->noise_file == NULL) &&
            read_value(&k_keys[i], value, settings->value[i], where, err,
                       err_size) != 0)
            return -1;
        settings->set[i] = true;
        snprintf(settings->where[i], sizeof settings->where[i], "%s", where);
        return 0;
    }
    snprintf(err, err_size,
             "%s: unknown key '%.40s' (brume render --help lists them)", where,
             name);
    return -1;
}

/* A line without its comment; what does not fit is left for the next, for the
 * caller to refuse. False at the end of the file. */
static bool next_line(FILE *f, char line[SCENE_LINE_SIZE + 1])
{
    size_t n = 0;
    bool comment = false;
    int c = getc(f);
    if (c == EOF)
        return false;
    for (; c != EOF && c != '\n'; c = getc(f)) {
        comment = comment || c == '#';
        if (comment)
            continue;
        /* A zero would hide the rest of the line: any other control
         * character is refused. */
        line[n++] = c == 0 ? '\1' : (char)c;
        if (n == SCENE_LINE_SIZE)
            break;
    }
    line[n] = '\0';
    return true;
}

int scene_read(struct scene_settings *settings, const char *path, char *err,
               size_t err_size)
{
    char line[SCENE_LINE_SIZE + 1], where[SCENE_WHERE_SIZE];
    FILE *f = fopen(path, "r");
    int result = 0;
    if (f == NULL) {
        snprintf(err, err_size, "%s: %s", path, strerror(errno));
        return -1;
    }
    for (int n = 1; result == 0 && next_line(f, line); n++) {
        snprintf(where, sizeof where, "%.250s:%d", path, n);
        bool fits = strlen(line) < SCENE_LINE_SIZE;
        const char *text = fits ? trimmed(line) : line;
        if (*text)
            result = scene_set(settings, text, where, err, err_size);
    }
    if (result == 0 && ferror(f)) {
        snprintf(err, err_size, "%s: %s", path, strerror(errno));
        result = -1;
    }
    fclose(f);
    return result;
}

/// To the core ///

static uint64_t q32(double v)
{
    return (uint64_t)floor(v * 4294967296.0 + 0.5);
}

static uint32_t q16(double v)
{
    return (uint32_t)floor(v * 65536.0 + 0.5);
}

static int apply_point(const struct scene_settings *s, int key,
                       const struct volume_file *file, int32_t out[3],
                       char *err, size_t err_size)
{
    double pool[3];
    if (!s->set[key])
        return 0;
    volume_file_to_pool(file, s->value[key], pool);
    for (int i = 0; i < 3; i++) {
        if (!(fabs(pool[i]) <= BRUME_MAX_COORDINATE / 65536.0)) {
            snprintf(err, err_size,
                     "%s: %s is %.0f voxels from the volume's corner, at most "
                     "%d can be reached",
                     s->where[key], k_keys[key].name, fabs(pool[i]),
                     BRUME_MAX_COORDINATE >> 16);
            return -1;
        }
        out[i] = (int32_t)floor(pool[i] * 65536.0 + 0.5);
    }
    return 0;
}

/* A direction of any length, as Q2.30. */
static int apply_direction(const struct volume_file *file, const double v[3],
                           int32_t out[3])
{
    double pool[3];
    volume_file_direction(file, v, pool);
    double length =
        sqrt(pool[0] * pool[0] + pool[1] * pool[1] + pool[2] * pool[2]);
    if (!(length > 0) || !isfinite(length))
        return -1;
    for (int i = 0; i < 3; i++)
        out[i] = (int32_t)floor(pool[i] / length * 1073741824.0 + 0.5);
    return 0;
}

static bool is_rotated(const struct volume_file *file)
{
    const double *m = file->world_from_index;
    return m[1] != 0 || m[2] != 0 || m[4] != 0 || m[6] != 0 || m[8] != 0 ||
           m[9] != 0 || !(m[0] > 0 && m[5] > 0 && m[10] > 0);
}

/* The sun's angles are in world axes: the core's own direction, unless the
 * volume is turned. */
static int apply_sun(const struct scene_settings *s,
                     const struct volume_file *file, struct brume_scene *out)
{
    const double *a = s->value[SCENE_SUN];
    int32_t angles[2] = {-60 * 65536, 30 * 65536}, q30[3];
    double v[3];
    if (s->set[SCENE_SUN])
        for (int i = 0; i < 2; i++)
            angles[i] = (int32_t)floor(a[i] * 65536.0 + 0.5);
    brume_direction(q30, angles[0], angles[1]);
    if (!is_rotated(file)) {
        memcpy(out->sun, q30, sizeof q30);
        return 0;
    }
    for (int i = 0; i < 3; i++)
        v[i] = q30[i];
    return apply_direction(file, v, out->sun);
}

/* Nothing said, and axes like the world's: the core's own default, to the
 * bit. */
static int apply_up(const struct scene_settings *s,
                    const struct volume_file *file, struct brume_scene *out,
                    char *err, size_t err_size)
{
    static const double k_up[3] = {0, 1, 0};
    const double *up = s->set[SCENE_UP] ? s->value[SCENE_UP] : k_up;
    if ((!s->set[SCENE_UP] && !is_rotated(file)) ||
        apply_direction(file, up, out->up) == 0)
        return 0;
    snprintf(err, err_size, "%s: up has no direction", s->where[SCENE_UP]);
    return -1;
}

/* The default camera is set in pool axes; in a turned volume it is moved so
 * that it looks the same way in world axes, from where a sphere around the box
 * fits 40 degrees, or as far as the core's limits allow. */
static void turn_camera(const struct volume_file *file, struct brume_scene *s)
{
    double from[3], away[3], length = 0, square = 0;
    for (int i = 0; i < 3; i++) {
        double side = file->volume.box_max[i] - file->volume.box_min[i] + 2;
        from[i] = s->eye[i] - (double)s->target[i];
        length += from[i] * from[i];
        square += side * side;
    }
    volume_file_direction(file, from, away);
    /* 1 / sin 20 degrees, and half of the diagonal */
    double scale = sqrt(square / length) * 65536.0 * 2.93 / 2;
    scale *= file->voxel_size; /* which volume_file_direction divides by */
    for (int i = 0; i < 3; i++) {
        double room =
            BRUME_MAX_COORDINATE - (away[i] < 0 ? -1.0 : 1.0) * s->target[i];
        if (fabs(away[i]) * scale > room)
            scale = room / fabs(away[i]);
    }
    for (int i = 0; i < 3; i++)
        s->eye[i] = s->target[i] + (int32_t)floor(away[i] * scale);
}

/* The core's default light is uniform; doubling steps start from a voxel and
 * go on until the distance passes the box's diagonal. */
static void default_light(const struct scene_settings *s,
                          const struct volume_file *file,
                          struct brume_scene *out)
{
    double square = 0;
    if (!s->set[SCENE_LIGHT] || out->light != BRUME_LOG)
        return;
    if (!s->set[SCENE_LIGHT_STEP])
        out->light_step = q16(1);
    for (int i = 0; i < 3; i++) {
        double side = file->volume.box_max[i] - file->volume.box_min[i] + 1;
        square += side * side;
    }
    double steps = sqrt(square) * 65536.0 / out->light_step;
    double n = fmax(1, ceil(log2(steps)));
    if (!s->set[SCENE_LIGHT_SAMPLES])
        out->light_samples = (uint16_t)fmin(n, BRUME_MAX_LOG_SAMPLES);
}

static void apply_numbers(const struct scene_settings *s,
                          struct brume_scene *out)
{
#define SET(key, field, value_of) \
    if (s->set[key]) \
    out->field = value_of(s->value[key][0])
    SET(SCENE_FOV, fov, q16);
    SET(SCENE_DENSITY_SCALE, density_scale, q32);
    SET(SCENE_LIGHT_DENSITY_SCALE, light_density_scale, q32);
    SET(SCENE_ALBEDO, albedo, q16);
    SET(SCENE_STEP, step, q16);
    SET(SCENE_MIN_DENSITY, min_density, q32);
    SET(SCENE_MIN_TRANSMITTANCE, min_transmittance, q16);
    SET(SCENE_MAX_DENSITY, max_density, q32);
    SET(SCENE_FILTER, filter, (uint8_t));
    SET(SCENE_LIGHT, light, (uint8_t));
    SET(SCENE_LIGHT_SAMPLES, light_samples, (uint16_t));
    SET(SCENE_LIGHT_STEP, light_step, q16);
    SET(SCENE_JITTER, jitter, (uint8_t));
    SET(SCENE_FRAME, frame, (uint32_t));
    SET(SCENE_OUTPUT, output, (uint8_t));
    SET(SCENE_SKIP, skip, (bool));
#undef SET
    if (s->set[SCENE_NOISE] && s->noise_file == NULL)
        noise_choose((unsigned)s->value[SCENE_NOISE][0], out);
    if (s->set[SCENE_NOISE] && s->noise_file != NULL) {
        out->noise = BRUME_NOISE_TABLE;
        out->noise_table = s->noise_file;
    }
    if (s->set[SCENE_SIZE]) {
        out->width = (uint16_t)s->value[SCENE_SIZE][0];
        out->height = (uint16_t)s->value[SCENE_SIZE][1];
    }
    for (int i = 0; s->set[SCENE_BACKGROUND] && i < 3; i++)
        out->background[i] = q16(s->value[SCENE_BACKGROUND][i]);
}

int scene_apply(const struct scene_settings *settings,
                const struct volume_file *file, struct brume_scene *scene,
                char *err, size_t err_size)
{
    const struct scene_settings *s = settings;
    brume_scene_default(scene, &file->volume);
    apply_numbers(s, scene);
    default_light(s, file, scene);
    if (is_rotated(file))
        turn_camera(file, scene);
    if (apply_point(s, SCENE_EYE, file, scene->eye, err, err_size) != 0 ||
        apply_point(s, SCENE_TARGET, file, scene->target, err, err_size) != 0 ||
        apply_up(s, file, scene, err, err_size) != 0 ||
        apply_sun(s, file, scene) != 0)
        return -1;
    if (scene->light == BRUME_LOG &&
        scene->light_samples > BRUME_MAX_LOG_SAMPLES) {
        snprintf(err, err_size, "%s: light_samples is %d, log takes up to %d",
                 s->where[SCENE_LIGHT_SAMPLES], scene->light_samples,
                 BRUME_MAX_LOG_SAMPLES);
        return -1;
    }
    if (memcmp(scene->eye, scene->target, sizeof scene->eye) == 0) {
        const int key = s->set[SCENE_EYE] ? SCENE_EYE : SCENE_TARGET;
        snprintf(err, err_size, "%s: eye and target are the same",
                 s->where[key]);
        return -1;
    }
    return 0;
}

/// Printing ///

static void print_point(FILE *to, const char *name, const int32_t q[3],
                        const struct volume_file *file)
{
    double pool[3], world[3];
    for (int i = 0; i < 3; i++)
        pool[i] = q[i] / 65536.0;
    volume_file_to_world(file, pool, world);
    fprintf(to, "%s = %.17g,%.17g,%.17g\n", name, world[0], world[1], world[2]);
}

static void print_q32(FILE *to, int key, uint64_t value)
{
    fprintf(to, "%s = %.17g\n", k_keys[key].name,
            fmin((double)value / 4294967296.0, k_keys[key].max));
}

static void print_word(FILE *to, int key, unsigned value)
{
    const char *words = k_keys[key].words;
    for (; value > 0; value--) {
        words += strcspn(words, " ");
        words += strspn(words, " ");
    }
    fprintf(to, "%s = %.*s\n", k_keys[key].name, (int)strcspn(words, " "),
            words);
}

/* A direction turned from pool to world axes. */
static void world_direction(const struct volume_file *file, const int32_t q[3],
                            double out[3])
{
    const double *m = file->world_from_index;
    for (int i = 0; i < 3; i++)
        out[i] = (m[4 * i] * q[0] + m[4 * i + 1] * q[1] + m[4 * i + 2] * q[2]) /
                 (file->voxel_size * 1073741824.0);
}

void scene_print(FILE *to, const struct brume_scene *scene,
                 const struct volume_file *file)
{
    const struct brume_scene *s = scene;
    const double degrees = 180 / 3.14159265358979323846;
    double v[3];
    fprintf(to, "size = %dx%d\n", s->width, s->height);
    print_point(to, "eye", s->eye, file);
    print_point(to, "target", s->target, file);
    world_direction(file, s->up, v);
    fprintf(to, "up = %.17g,%.17g,%.17g\n", v[0], v[1], v[2]);
    fprintf(to, "fov = %.9g\n", s->fov / 65536.0);
    world_direction(file, s->sun, v);
    fprintf(to, "sun = %.9g %.9g\n", atan2(v[0], v[2]) * degrees,
            atan2(v[1], sqrt(v[0] * v[0] + v[2] * v[2])) * degrees);
    print_q32(to, SCENE_DENSITY_SCALE, s->density_scale);
    print_q32(to, SCENE_LIGHT_DENSITY_SCALE, s->light_density_scale);
    fprintf(to, "albedo = %.9g\n", s->albedo / 65536.0);
    fprintf(to, "step = %.9g\n", s->step / 65536.0);
    print_q32(to, SCENE_MIN_DENSITY, s->min_density);
    fprintf(to, "min_transmittance = %.9g\n", s->min_transmittance / 65536.0);
    print_q32(to, SCENE_MAX_DENSITY, s->max_density);
    print_word(to, SCENE_FILTER, s->filter);
    print_word(to, SCENE_LIGHT, s->light);
    fprintf(to, "light_samples = %d\n", s->light_samples);
    fprintf(to, "light_step = %.9g\n", s->light_step / 65536.0);
    print_word(to, SCENE_JITTER, s->jitter);
    print_word(to, SCENE_NOISE, noise_number(s));
    fprintf(to, "frame = %lu\n", (unsigned long)s->frame);
    fprintf(to, "background = %.9g,%.9g,%.9g\n", s->background[0] / 65536.0,
            s->background[1] / 65536.0, s->background[2] / 65536.0);
    print_word(to, SCENE_OUTPUT, s->output);
    print_word(to, SCENE_SKIP, s->skip);
}
