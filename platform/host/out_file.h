/* SPDX-License-Identifier: MIT */
/*
 * Files that appear whole or not at all: bytes go to `path`.tmp<process id>,
 * which then replaces `path`. A path that exists and is not a regular file (a
 * pipe, a symbolic link such as /dev/stdout) is written directly, and "-" is
 * stdout.
 *
 * Errors: as in image.h; messages do not name the path.
 */
#ifndef BRUME_HOST_OUT_FILE_H
#define BRUME_HOST_OUT_FILE_H

#include <stddef.h>
#include <stdio.h>

struct out_file {
    FILE *file;
    const char *path;
    char *temporary; /* NULL: written directly */
};

/* `path` must stay until the file is closed. */
int out_open(struct out_file *out, const char *path, char *err,
             size_t err_size);
int out_write(struct out_file *out, const void *data, size_t size, char *err,
              size_t err_size);

/* Ends it, and puts it in its place. After any error nothing is left of it. */
int out_close(struct out_file *out, char *err, size_t err_size);

/* Removes what was written. Harmless after the end. */
void out_abandon(struct out_file *out);

#endif
