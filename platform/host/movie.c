/* SPDX-License-Identifier: MIT */
#include "movie.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "movie_codec.h"
#include "out_file.h"
#include "pattern.h"

#define MESSAGE_SIZE 256

struct movie {
    struct movie_format format;
    struct pool *pool;
    struct profile *profile;
    struct out_file file; /* of a film */
    struct apng apng;
    uint32_t added;
};

/// Names ///

static bool ends_in(const char *path, const char *extension)
{
    size_t n = strlen(path), m = strlen(extension);
    return n >= m && strcasecmp(path + n - m, extension) == 0;
}

int movie_kind_of(const char *path, bool many, struct movie_format *format,
                  char *err, size_t err_size)
{
    bool apng = ends_in(path, ".apng");
    bool y4m = ends_in(path, ".y4m") || strcmp(path, "-") == 0;
    format->path = path;
    format->kind = apng   ? MOVIE_APNG
                   : y4m  ? MOVIE_Y4M
                   : many ? MOVIE_PICTURES
                          : MOVIE_STILL;
    if ((apng || y4m) && !many)
        return image_error(err, err_size, "%.200s: a film needs --frames A:B",
                           path);
    if (format->kind == MOVIE_PICTURES &&
        pattern_check(path, err, err_size) != 0)
        return -1;
    if (apng || y4m)
        return 0;
    return image_format_of(path, &format->picture, err, err_size);
}

/// Films ///

static int no_memory(char *err, size_t err_size)
{
    return image_error(err, err_size, "not enough memory for a frame");
}

/* Writes `file`, or complains when `status` says that it could not be made;
 * frees it. */
static int put(struct movie *movie, struct image_file *file, int status,
               char *err, size_t err_size)
{
    double now = movie->profile ? profile_now() : 0;
    status = status == 0 ? out_write(&movie->file, file->data, file->size, err,
                                     err_size)
                         : no_memory(err, err_size);
    profile_add(movie->profile, PASS_WRITE, now);
    free(file->data);
    return status;
}

static int start(struct movie *movie, char *err, size_t err_size)
{
    const struct movie_format *f = &movie->format;
    struct image_file file = {NULL, 0};
    if (f->kind == MOVIE_STILL || f->kind == MOVIE_PICTURES)
        return 0;
    if (out_open(&movie->file, f->path, err, err_size) != 0)
        return -1;
    int status =
        f->kind == MOVIE_APNG ? apng_start(f, &file) : y4m_start(f, &file);
    return put(movie, &file, status, err, err_size);
}

struct movie *movie_open(const struct movie_format *format, struct pool *pool,
                         struct profile *profile, char *err, size_t err_size)
{
    char message[MESSAGE_SIZE] = "no memory";
    struct movie *movie = calloc(1, sizeof *movie);
    if (movie != NULL) {
        movie->format = *format;
        movie->pool = pool;
        movie->profile = profile;
        if (start(movie, message, sizeof message) == 0)
            return movie;
        out_abandon(&movie->file);
        free(movie);
    }
    image_error(err, err_size, "%.200s: %s", format->path, message);
    return NULL;
}

/* A film's frame. The encoders' processor time is that of all threads, which
 * only the clock of the process can tell. */
static int add_to_film(struct movie *movie, const struct image *image,
                       char *err, size_t err_size)
{
    struct image_file file = {NULL, 0};
    double now = profile_process();
    int status = movie->format.kind == MOVIE_APNG
                     ? apng_frame(&movie->apng, &movie->format, movie->pool,
                                  image, &file)
                     : y4m_frame(movie->pool, image, &file);
    profile_add_process(movie->profile, PASS_ENCODE, now);
    return put(movie, &file, status, err, err_size);
}

static int add_picture(struct movie *movie, const char *path,
                       const struct image *image, char *err, size_t err_size)
{
    struct image_file file = {NULL, 0};
    double now = profile_process();
    int status = image_encode(movie->format.picture, image, movie->pool, &file,
                              err, err_size);
    profile_add_process(movie->profile, PASS_ENCODE, now);
    now = profile_now();
    if (status == 0)
        status = image_put(path, &file, err, err_size);
    profile_add(movie->profile, PASS_WRITE, now);
    free(file.data);
    return status;
}

int movie_add(struct movie *movie, const struct image *image, uint32_t number,
              char *err, size_t err_size)
{
    char message[MESSAGE_SIZE], name[PATTERN_SIZE];
    const char *path = movie->format.path;
    int status;
    if (movie->format.kind == MOVIE_PICTURES) {
        pattern_name(path, number, name);
        path = name;
    }
    if (movie->format.kind <= MOVIE_PICTURES)
        status = add_picture(movie, path, image, message, sizeof message);
    else
        status = add_to_film(movie, image, message, sizeof message);
    movie->added++;
    if (status == 0)
        return 0;
    movie->added = 0; /* not whole any more */
    return image_error(err, err_size, "%.200s: %s", path, message);
}

int movie_close(struct movie *movie, char *err, size_t err_size)
{
    char message[MESSAGE_SIZE];
    struct image_file file = {NULL, 0};
    int status = 0;
    if (movie->format.kind > MOVIE_PICTURES) {
        bool whole = movie->added == movie->format.frames;
        if (whole && movie->format.kind == MOVIE_APNG)
            status =
                put(movie, &file, apng_end(&file), message, sizeof message);
        if (whole && status == 0)
            status = out_close(&movie->file, message, sizeof message);
        else
            out_abandon(&movie->file);
        if (status != 0)
            image_error(err, err_size, "%.200s: %s", movie->format.path,
                        message);
    }
    apng_free(&movie->apng);
    free(movie);
    return status;
}
