/* SPDX-License-Identifier: MIT */
#include "sequence.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "backdrop.h"
#include "deflate.h"
#include "panel.h"
#include "pattern.h"
#include "scene_keys.h"
#include "sun_cache.h"

/* While it is drawn. */
struct run {
    const struct sequence *sequence;
    struct scene_settings settings; /* of the frame */
    struct scene_settings base;     /* of all frames */
    struct scene_light light;       /* of the frame */
    struct sun_cache sun;
    struct volume_file file;
    struct volume_file before; /* its transform and origin, not its bytes */
    int32_t anchor[3];         /* of this one, from the first of its grid */
    bool jumps; /* voxels lie elsewhere than those of the frame before */
    bool is_float;
    int pixel_format;
    struct backdrop over;
    struct image image;
    void *packed; /* pixels that are not yet those of the image, or NULL */
    struct renderer *renderer;
    struct movie *movie;
    struct profile frame, sum;
    char *err;
    size_t err_size;
};

/// Volumes ///

static bool changes_volume(const struct sequence *s)
{
    return s->many && pattern_is(s->volume);
}

/* Bad names are found before the first frame is drawn. */
static int check_volumes(const struct sequence *s, char *err, size_t err_size)
{
    char name[PATTERN_SIZE];
    if (!changes_volume(s))
        return 0;
    if (pattern_check(s->volume, err, err_size) != 0)
        return -1;
    for (uint32_t frame = s->first;; frame++) {
        pattern_name(s->volume, frame, name);
        if (access(name, R_OK) != 0) {
            snprintf(err, err_size, "%.200s: %s", name, strerror(errno));
            return -1;
        }
        if (frame == s->last)
            return 0;
    }
}

/* Pools of one grid that were cut at different places are put where they
 * belong. When the grid itself is another one, history does not fit. */
static void place_volume(struct run *r)
{
    const struct volume_file *file = &r->file;
    size_t size = sizeof file->world_from_index;
    bool same =
        memcmp(file->world_from_index, r->before.world_from_index, size) == 0;
    r->jumps = r->before.size > 0 && !same;
    if (!same)
        r->before = *file;
    for (int i = 0; i < 3; i++)
        r->anchor[i] = (int32_t)((uint32_t)file->origin[i] -
                                 (uint32_t)r->before.origin[i]);
}

static void show_volume(struct run *r)
{
    renderer_volume(r->renderer, &r->file.volume);
    renderer_anchor(r->renderer, r->anchor);
}

/* The volume of a frame in r->file, where at most one is kept. */
static int open_volume(struct run *r, uint32_t frame)
{
    const struct sequence *s = r->sequence;
    char name[PATTERN_SIZE];
    const char *path = s->volume;
    double now = profile_now();
    if (r->file.data != NULL && !changes_volume(s))
        return 0;
    volume_file_close(&r->file);
    sun_cache_free(&r->sun);
    if (changes_volume(s)) {
        pattern_name(s->volume, frame, name);
        path = name;
    }
    int result = volume_file_open(&r->file, path, r->err, r->err_size);
    if (result == 0)
        place_volume(r);
    if (result == 0 && r->renderer != NULL)
        show_volume(r);
    profile_add(&r->frame, PASS_OPEN, now);
    return result;
}

/// Scenes ///

static int scene_of(struct run *r, uint32_t frame, struct brume_scene *scene)
{
    const struct sequence *s = r->sequence;
    r->settings = r->base;
    if (s->many) {
        r->settings.set[SCENE_FRAME] = true;
        r->settings.value[SCENE_FRAME][0] = frame;
    }
    if (s->path != NULL)
        path_apply(s->path, frame, &r->settings);
    if (scene_apply(&r->settings, &r->file, scene, &r->light, r->err,
                    r->err_size) != 0)
        return -1;
    if (r->is_float)
        scene->output = BRUME_LINEAR;
    if (s->over != NULL &&
        (scene->width != r->over.width || scene->height != r->over.height)) {
        snprintf(r->err, r->err_size, "%.200s: %dx%d, and the scene is %dx%d",
                 s->over, r->over.width, r->over.height, scene->width,
                 scene->height);
        return -1;
    }
    if (s->over != NULL) /* the picture has one */
        r->light.lighting.sky = false;
    scene->cut = scene->cut || r->jumps;
    return 0;
}

/* With a volume for each frame, what nobody set is what the first volume
 * suggests, for all of them: camera and light stand still. */
static int hold_defaults(struct run *r)
{
    struct brume_scene scene;
    char *text = NULL;
    size_t size = 0;
    if (!changes_volume(r->sequence))
        return 0;
    if (scene_apply(&r->base, &r->file, &scene, &r->light, r->err,
                    r->err_size) != 0)
        return -1;
    FILE *to = open_memstream(&text, &size);
    if (to != NULL) {
        scene_print(to, &scene, &r->light, &r->file);
        fclose(to);
    }
    int result =
        text == NULL ? -1 : scene_fill(&r->base, text, r->err, r->err_size);
    if (text == NULL)
        snprintf(r->err, r->err_size, "no memory for the scene");
    free(text);
    return result;
}

/* Errors of any frame are found before the first one is drawn. */
static int check_scenes(struct run *r)
{
    const struct sequence *s = r->sequence;
    struct brume_scene scene;
    for (uint32_t frame = s->first;; frame++) {
        if (scene_of(r, frame, &scene) != 0)
            return -1;
        if (frame == s->last || s->path == NULL || changes_volume(s))
            return 0;
    }
}

/// Pixels ///

/* Is there no colour in any of its pictures? */
static bool is_grey(const struct run *r, const struct brume_scene *scene)
{
    const struct path *path = r->sequence->path;
    const uint32_t *b = scene->background;
    if (r->sequence->over != NULL)
        return false;
    for (int key = 0; path != NULL && key < SCENE_KEYS; key++)
        if (path_sets(path, key) &&
            (scene_keys[key].kind == SCENE_IS_COLOUR || key == SCENE_SKY ||
             key == SCENE_AMBIENT || key == SCENE_EMISSION))
            return false;
    if (scene->lighting != NULL && scene_light_has_colour(&r->light))
        return false;
    return (scene->lighting != NULL && scene->lighting->sky) ||
           (b[0] == b[1] && b[1] == b[2]);
}

/* What the pixels are drawn in. */
static int pixel_format_of(const struct run *r, const struct brume_scene *scene)
{
    if (r->sequence->pixels >= 0)
        return r->sequence->pixels;
    if (is_grey(r, scene))
        return r->is_float ? BRUME_L16 : BRUME_L8;
    return r->is_float ? BRUME_RGB161616 : BRUME_RGB888;
}

static int channels_of(int pixel_format)
{
    if (pixel_format == BRUME_L16)
        return 1;
    return pixel_format == BRUME_RGB161616 ? 3 : panel_channels(pixel_format);
}

/* Does the file hold what a panel's format has? */
static int check_pixels(struct run *r, const struct movie_format *format)
{
    const struct sequence *s = r->sequence;
    if (s->over != NULL && s->pixels >= 0 &&
        (brume_pixel_bytes(s->pixels) == 0 || s->pixels == BRUME_RGBA8888)) {
        snprintf(r->err, r->err_size,
                 "--over takes --pixels of 8 bits or more, without alpha");
        return -1;
    }
    bool png = format->kind == MOVIE_APNG ||
               (format->kind <= MOVIE_PICTURES && format->picture == IMAGE_PNG);
    if (s->pixels < 0 ||
        !(r->is_float || (s->out && !png && s->pixels == BRUME_RGBA8888)))
        return 0;
    snprintf(r->err, r->err_size, "%.200s: --pixels %s", s->out,
             r->is_float ? "is of 8-bit pictures, not of a .pfm"
                         : "rgba8888 goes into .png and .apng alone");
    return -1;
}

/* Pixels of the core that are the image's as they are need no second place. */
static int new_image(struct run *r, const struct brume_scene *scene)
{
    int format = r->pixel_format, channels = channels_of(format);
    struct image *image = &r->image;
    if (r->is_float ? image_new_f32(image, scene->width, scene->height,
                                    channels, r->err, r->err_size) != 0
                    : image_new_u8(image, scene->width, scene->height, channels,
                                   r->err, r->err_size) != 0)
        return -1;
    if (format == BRUME_L8 || format == BRUME_RGB888)
        return 0;
    r->packed = malloc(brume_row_bytes(format, scene->width) * scene->height);
    if (r->packed != NULL)
        return 0;
    snprintf(r->err, r->err_size, "not enough memory for %dx%d", scene->width,
             scene->height);
    return -1;
}

/* Pixels of the core's formats, made the image's: 65535 is 1 in floats. */
static int draw(struct run *r, const struct brume_scene *scene)
{
    const struct render_target target = {
        r->pixel_format, r->packed ? r->packed : r->image.u8,
        brume_row_bytes(r->pixel_format, scene->width),
        (const uint32_t(*)[3])r->over.linear};
    const uint16_t *wide = r->packed;
    if (sun_cache_prepare(&r->sun, r->renderer, &r->file.volume, scene,
                          &r->light, r->err, r->err_size) != 0)
        return -1;
    if (renderer_draw(r->renderer, scene, &target, r->err, r->err_size) != 0)
        return -1;
    for (size_t i = 0; r->is_float && i < image_samples(&r->image); i++)
        r->image.f32[i] = (float)(wide[i] / 65535.0);
    if (r->packed != NULL && !r->is_float)
        panel_expand(r->pixel_format, r->packed, &r->image);
    return 0;
}
static int print_hash(const struct run *r, uint32_t frame)
{
    uint32_t crc = deflate_crc32(0, r->image.u8, image_samples(&r->image));
    if (r->sequence->many)
        printf("frame=%lu ", (unsigned long)frame);
    printf("crc32=%08lx\n", (unsigned long)crc);
    if (fflush(stdout) == 0 && !ferror(stdout))
        return 0;
    snprintf(r->err, r->err_size, "cannot write the hash");
    return -1;
}

/// Frames ///

static int one_frame(struct run *r, uint32_t frame)
{
    struct brume_scene scene;
    if (open_volume(r, frame) != 0 || scene_of(r, frame, &scene) != 0 ||
        draw(r, &scene) != 0)
        return 2;
    if (r->sequence->hash && print_hash(r, frame) != 0)
        return 1;
    if (r->movie != NULL &&
        movie_add(r->movie, &r->image, frame, r->err, r->err_size) != 0)
        return 1;
    return 0;
}

/* Ends a frame's row of the profile. */
static void end_row(struct run *r, uint32_t frame, double start)
{
    char name[32];
    static const struct profile k_zero;
    r->frame.wall += profile_clock() - start;
    r->frame.frames = 1;
    snprintf(name, sizeof name, "frame %lu", (unsigned long)frame);
    if (r->sequence->profile && r->sequence->many)
        profile_print(stderr, name, &r->frame);
    profile_sum(&r->sum, &r->frame);
    r->frame = k_zero;
}

static int all_frames(struct run *r)
{
    const struct sequence *s = r->sequence;
    bool bar = !s->profile && isatty(STDERR_FILENO) != 0;
    renderer_progress(r->renderer, bar ? s->last - s->first + 1 : 0);
    if (s->profile)
        profile_print_head(stderr);
    int status = 0;
    for (uint32_t frame = s->first; status == 0; frame++) {
        double start = profile_clock();
        status = one_frame(r, frame);
        end_row(r, frame, start);
        if (frame == s->last)
            break;
    }
    renderer_hush(r->renderer);
    if (s->profile && status == 0)
        profile_print(stderr, "all", &r->sum);
    return status;
}

/* Frames of a renderer, into a movie. */
static int run_frames(struct run *r, const struct movie_format *format)
{
    const struct sequence *s = r->sequence;
    r->renderer = renderer_new(s->threads, s->kernel);
    if (r->renderer == NULL) {
        snprintf(r->err, r->err_size, "not enough memory");
        return 2;
    }
    show_volume(r);
    if (s->profile)
        renderer_profile(r->renderer, &r->frame);
    if (s->out != NULL) {
        r->movie = movie_open(format, renderer_pool(r->renderer), &r->frame,
                              r->err, r->err_size);
        if (r->movie == NULL)
            return 1;
    }
    int status = all_frames(r);
    char *err = status ? NULL : r->err; /* keep the first message */
    if (r->movie != NULL &&
        movie_close(r->movie, err, err ? r->err_size : 0) != 0 && status == 0)
        status = 1;
    return status;
}

static int prepare(struct run *r, struct movie_format *format)
{
    const struct sequence *s = r->sequence;
    struct brume_scene scene;
    if (s->out &&
        movie_kind_of(s->out, s->many, format, r->err, r->err_size) != 0)
        return -1;
    r->is_float = s->out && format->kind <= MOVIE_PICTURES &&
                  format->picture == IMAGE_PFM;
    if (s->hash && (r->is_float || (s->out && strcmp(s->out, "-") == 0))) {
        snprintf(r->err, r->err_size, "--hash is of 8-bit pictures, not of %s",
                 r->is_float ? "a .pfm" : "a film on stdout");
        return -1;
    }
    if (s->over != NULL &&
        backdrop_read(s->over, &r->over, r->err, r->err_size) != 0)
        return -1;
    if (check_pixels(r, format) != 0 ||
        check_volumes(s, r->err, r->err_size) != 0 ||
        open_volume(r, s->first) != 0 || hold_defaults(r) != 0 ||
        check_scenes(r) != 0 || scene_of(r, s->first, &scene) != 0)
        return -1;
    r->pixel_format = pixel_format_of(r, &scene);
    format->width = scene.width;
    format->height = scene.height;
    format->channels = channels_of(r->pixel_format);
    format->frames = s->last - s->first + 1;
    format->rate[0] = s->rate[0];
    format->rate[1] = s->rate[1];
    return new_image(r, &scene);
}

int sequence_run(const struct sequence *sequence, char *err, size_t err_size)
{
    struct movie_format format = {.kind = MOVIE_STILL};
    struct run *r = calloc(1, sizeof *r);
    if (r == NULL) {
        snprintf(err, err_size, "not enough memory");
        return 2;
    }
    r->sequence = sequence;
    r->base = *sequence->settings;
    r->err = err;
    r->err_size = err_size;
    double start = profile_clock();
    int status = prepare(r, &format) != 0 ? 2 : 0;
    r->frame.wall = profile_clock() - start;
    if (status == 0)
        status = run_frames(r, &format);
    renderer_free(r->renderer);
    volume_file_close(&r->file);
    sun_cache_free(&r->sun);
    image_free(&r->image);
    backdrop_free(&r->over);
    free(r->packed);
    free(r);
    return status;
}
