/* SPDX-License-Identifier: MIT */
/*
 * Paths: values of scene keys at keyframes, and between them.
 *
 *     [0]                 # a frame
 *     eye = 0,20,90       # any scene key but size and frame
 *     ease = spline       # linear, smooth or spline, from here on
 *     [48]
 *     eye = 60,20,60
 *     cut = on            # the keys set here jump to their values
 *
 * A key moves between the keyframes that set it, and is held before the first
 * and after the last. Words are held until the next. docs/sequences.md has
 * the formulas.
 *
 * Errors: as in image.h; messages start with file:line.
 */
#ifndef BRUME_HOST_PATH_FILE_H
#define BRUME_HOST_PATH_FILE_H

#include "scene_file.h"

struct path;

/* NULL on errors. */
struct path *path_read(const char *file, char *err, size_t err_size);
void path_free(struct path *path);

/* Does any keyframe set this key? */
bool path_sets(const struct path *path, int key);

/* Sets the path's keys to their values in a frame. Others stay as they are. */
void path_apply(const struct path *path, uint32_t frame,
                struct scene_settings *settings);

#endif
