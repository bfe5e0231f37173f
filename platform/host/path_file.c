/* SPDX-License-Identifier: MIT */
#include "path_file.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene_keys.h"

#define MAX_ENTRIES 1000000u

enum ease { EASE_LINEAR, EASE_SMOOTH, EASE_SPLINE };

/* A keyframe's value of one key. */
struct entry {
    int key;
    uint32_t frame;
    bool cut;       /* jumps to this value */
    enum ease ease; /* towards the next one */
    unsigned line;
    double value[SCENE_VALUES];
    const struct brume_noise_table *noise_file;
    const struct scene_file_data *file; /* of the key */
    const struct emission_file *emission_file;
};

struct path {
    char *name;
    struct entry *entry; /* by key, then by frame */
    size_t count, room;
    size_t first[SCENE_KEYS + 1]; /* entries of each key start here */
};

/// Reading ///

/* Where the reader is. */
struct reader {
    struct path *path;
    unsigned line;
    bool in_section;
    uint32_t frame;
    size_t section; /* its first entry */
    bool cut;
    enum ease ease;
    char where[SCENE_WHERE_SIZE];
    char *err;
    size_t err_size;
};

static int fail(const struct reader *r, const char *what, const char *text)
{
    snprintf(r->err, r->err_size, "%s: %s '%.40s'", r->where, what, text);
    return -1;
}

static struct entry *new_entry(struct reader *r, int key)
{
    struct path *p = r->path;
    if (p->count == p->room) {
        size_t room = p->room ? 2 * p->room : 64;
        struct entry *more =
            room > MAX_ENTRIES ? NULL : realloc(p->entry, room * sizeof *more);
        if (more == NULL) {
            snprintf(r->err, r->err_size, "%s: too many keyframes", r->where);
            return NULL;
        }
        p->entry = more;
        p->room = room;
    }
    struct entry *e = &p->entry[p->count++];
    memset(e, 0, sizeof *e);
    e->key = key;
    e->frame = r->frame;
    e->line = r->line;
    return e;
}

/* What a section says of all its keys is known at its end. */
static int end_section(struct reader *r)
{
    if (r->cut && new_entry(r, SCENE_CUT) == NULL)
        return -1;
    for (size_t i = r->section; i < r->path->count; i++) {
        r->path->entry[i].cut = r->cut;
        r->path->entry[i].ease = r->ease;
    }
    r->section = r->path->count;
    return 0;
}

/* A line `[FRAME]`. */
static int read_section(struct reader *r, char *text)
{
    char *end;
    size_t n = strlen(text);
    if (n < 3 || text[n - 1] != ']')
        return fail(r, "a keyframe is [FRAME], not", text);
    text[n - 1] = '\0';
    char *number = scene_trimmed(text + 1);
    errno = 0;
    unsigned long long frame = strtoull(number, &end, 10);
    if (*number < '0' || *number > '9' || *end != '\0' || errno ||
        frame > UINT32_MAX)
        return fail(r, "a frame is a whole number from 0 to 4294967295, not",
                    number);
    if (r->in_section && frame <= r->frame)
        return fail(
            r, "keyframes go upwards; not later than the one before:", number);
    if (end_section(r) != 0)
        return -1;
    r->in_section = true;
    r->frame = (uint32_t)frame;
    r->cut = false;
    return 0;
}

/* Number of `word` in a list that ends with NULL, or -1. */
static int find_word(const char *const *words, const char *word)
{
    for (int i = 0; words[i] != NULL; i++)
        if (strcmp(words[i], word) == 0)
            return i;
    return -1;
}

/* `cut = WORD` and `ease = WORD`: 1 when the line is another one. */
static int read_own(struct reader *r, const char *text)
{
    static const char *const k_ease[] = {"linear", "smooth", "spline", NULL};
    static const char *const k_cut[] = {"off", "on", NULL};
    char copy[SCENE_LINE_SIZE];
    strcpy(copy, text);
    char *equals = strchr(copy, '=');
    if (equals == NULL)
        return 1;
    *equals = '\0';
    const char *name = scene_trimmed(copy), *word = scene_trimmed(equals + 1);
    if (strcmp(name, "ease") == 0) {
        int ease = find_word(k_ease, word);
        if (ease < 0)
            return fail(r, "ease is one of linear smooth spline, not", word);
        r->ease = (enum ease)ease;
        return 0;
    }
    if (strcmp(name, "cut") != 0)
        return 1;
    int cut = find_word(k_cut, word);
    if (cut < 0)
        return fail(r, "cut is one of off on, not", word);
    r->cut = cut > 0;
    return 0;
}

static int read_key(struct reader *r, const char *text)
{
    struct scene_settings set;
    int key = 0;
    memset(&set, 0, sizeof set);
    if (scene_set(&set, text, r->where, r->err, r->err_size) != 0)
        return -1;
    while (!set.set[key])
        key++;
    if (key == SCENE_SIZE || key == SCENE_FRAME)
        return fail(r, "size and frame cannot change on a path:", text);
    for (size_t i = r->section; i < r->path->count; i++)
        if (r->path->entry[i].key == key)
            return fail(r, "set twice at one keyframe:", text);
    struct entry *e = new_entry(r, key);
    if (e == NULL)
        return -1;
    memcpy(e->value, set.value[key], sizeof e->value);
    e->noise_file = set.noise_file;
    if (scene_keys[key].kind == SCENE_IS_FILE)
        e->file = set.file[key - SCENE_FILE_FIRST];
    e->emission_file = set.emission_file;
    return 0;
}

static int read_line(struct reader *r, char *line)
{
    snprintf(r->where, sizeof r->where, "%.250s:%u", r->path->name, r->line);
    if (scene_check_line(line, r->where, r->err, r->err_size) != 0)
        return -1;
    char *text = scene_trimmed(line);
    if (*text == '\0')
        return 0;
    if (*text == '[')
        return read_section(r, text);
    if (!r->in_section)
        return fail(r, "before the first [FRAME]:", text);
    int own = read_own(r, text);
    return own <= 0 ? own : read_key(r, text);
}

static int read_lines(struct reader *r, FILE *f)
{
    char line[SCENE_LINE_SIZE + 1];
    int result = 0;
    for (r->line = 1; result == 0 && scene_next_line(f, line); r->line++)
        result = read_line(r, line);
    if (result == 0 && ferror(f)) {
        snprintf(r->err, r->err_size, "%s: %s", r->path->name, strerror(errno));
        result = -1;
    }
    if (result == 0)
        result = end_section(r);
    if (result == 0 && !r->in_section) {
        snprintf(r->err, r->err_size, "%s: no keyframe [FRAME] in it",
                 r->path->name);
        result = -1;
    }
    return result;
}

static int by_key(const void *a, const void *b)
{
    const struct entry *p = a, *q = b;
    if (p->key != q->key)
        return p->key - q->key;
    return p->frame < q->frame ? -1 : p->frame > q->frame;
}

static void index_keys(struct path *path)
{
    size_t i = 0;
    qsort(path->entry, path->count, sizeof *path->entry, by_key);
    for (int key = 0; key <= SCENE_KEYS; key++) {
        while (i < path->count && path->entry[i].key < key)
            i++;
        path->first[key] = i;
    }
}

struct path *path_read(const char *file, char *err, size_t err_size)
{
    struct reader r = {.err = err, .err_size = err_size};
    FILE *f = fopen(file, "r");
    if (f == NULL) {
        snprintf(err, err_size, "%s: %s", file, strerror(errno));
        return NULL;
    }
    r.path = calloc(1, sizeof *r.path);
    if (r.path != NULL)
        r.path->name = strdup(file);
    if (r.path == NULL || r.path->name == NULL || read_lines(&r, f) != 0) {
        if (r.path == NULL || r.path->name == NULL)
            snprintf(err, err_size, "%s: no memory", file);
        path_free(r.path);
        r.path = NULL;
    }
    fclose(f);
    if (r.path != NULL)
        index_keys(r.path);
    return r.path;
}

void path_free(struct path *path)
{
    if (path == NULL)
        return;
    free(path->name);
    free(path->entry);
    free(path);
}

/// Values ///

bool path_sets(const struct path *path, int key)
{
    return path->first[key] < path->first[key + 1];
}

/* Slope at entry i, per frame, of the spline through the keyframes: that of
 * the parabola through it and its neighbours, which for equal distances is
 * Catmull and Rom's. At the ends, and on either side of a jump, that of the
 * straight line. */
static double slope(const struct entry *all, size_t i, size_t n, int c,
                    bool forwards)
{
    bool before = i > 0 && !all[i].cut;
    bool after = i + 1 < n && !all[i + 1].cut;
    double left = 0, right = 0, from = 0, to = 0;
    if (before) {
        from = (double)all[i].frame - all[i - 1].frame;
        left = (all[i].value[c] - all[i - 1].value[c]) / from;
    }
    if (after) {
        to = (double)all[i + 1].frame - all[i].frame;
        right = (all[i + 1].value[c] - all[i].value[c]) / to;
    }
    if (before && after)
        return (left * to + right * from) / (from + to);
    return forwards ? right : left;
}

/* Component c between entries i and i + 1, at u in 0 .. 1. */
static double between(const struct entry *all, size_t i, size_t n, int c,
                      double u)
{
    const struct entry *a = &all[i], *b = &all[i + 1];
    double p = a->value[c], q = b->value[c];
    if (a->ease == EASE_SMOOTH)
        u = u * u * (3 - 2 * u);
    if (a->ease != EASE_SPLINE)
        return p + (q - p) * u;
    double frames = (double)b->frame - a->frame, v = 1 - u;
    double s = slope(all, i, n, c, true) * frames;
    double t = slope(all, i + 1, n, c, false) * frames;
    /* Hermite's cubic */
    return v * v * (1 + 2 * u) * p + u * u * (3 - 2 * u) * q +
           u * v * (v * s - u * t);
}

/* The last entry not after the frame; the first one when there is none. */
static size_t entry_at(const struct entry *all, size_t n, uint32_t frame)
{
    size_t low = 0, high = n; /* the answer is in low .. high - 1 */
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (all[middle].frame <= frame)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static void set_key(const struct path *path, int key, uint32_t frame,
                    struct scene_settings *settings)
{
    const struct scene_key_info *k = &scene_keys[key];
    const struct entry *all = path->entry + path->first[key];
    size_t n = path->first[key + 1] - path->first[key];
    size_t i = entry_at(all, n, frame);
    bool moves = scene_key_moves(key) && i + 1 < n && !all[i + 1].cut &&
                 frame > all[i].frame;
    memcpy(settings->value[key], all[i].value, sizeof all[i].value);
    if (key == SCENE_NOISE)
        settings->noise_file = all[i].noise_file;
    else if (key == SCENE_EMISSION)
        settings->emission_file = all[i].emission_file;
    else if (scene_keys[key].kind == SCENE_IS_FILE)
        settings->file[key - SCENE_FILE_FIRST] = all[i].file;
    for (int c = 0; moves && c < 3; c++) {
        double u = ((double)frame - all[i].frame) /
                   ((double)all[i + 1].frame - all[i].frame);
        double v = between(all, i, n, c, u);
        if (k->kind == SCENE_IS_INTEGER)
            v = floor(v + 0.5);
        /* a spline may swing beyond the range */
        settings->value[key][c] = fmin(fmax(v, k->min), k->max);
    }
    settings->set[key] = true;
    snprintf(settings->where[key], sizeof settings->where[key], "%.250s:%u",
             path->name, all[i].line);
}

void path_apply(const struct path *path, uint32_t frame,
                struct scene_settings *settings)
{
    for (int key = 0; key < SCENE_KEYS; key++)
        if (key != SCENE_CUT && path_sets(path, key))
            set_key(path, key, frame, settings);
    /* history is dropped in the frame of a cut alone */
    for (size_t i = path->first[SCENE_CUT]; i < path->first[SCENE_CUT + 1]; i++)
        if (path->entry[i].frame == frame) {
            settings->set[SCENE_CUT] = true;
            settings->value[SCENE_CUT][0] = 1;
        }
}
