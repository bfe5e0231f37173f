/* SPDX-License-Identifier: MIT */
#include "out_set.h"

#include <string.h>

#include "out_file.h"

static int write_one(struct out_file *out, const char *path,
                     const struct image_file *file, char *err, size_t err_size)
{
    char what[400];
    if (out_open(out, path, what, sizeof what) == 0 &&
        out_write(out, file->data, file->size, what, sizeof what) == 0)
        return 0;
    return image_error(err, err_size, "%s: %s", path, what);
}

int out_set_write(int count, const char *const *path,
                  const struct image_file *file, char *err, size_t err_size)
{
    struct out_file out[OUT_SET_MOST];
    char what[400];
    int status = 0, opened = 0;
    memset(out, 0, sizeof out);
    for (; opened < count && status == 0; opened++)
        if (path[opened] != NULL)
            status = write_one(&out[opened], path[opened], &file[opened], err,
                               err_size);
    for (int i = 0; i < opened; i++) {
        if (path[i] == NULL)
            continue;
        if (status != 0)
            out_abandon(&out[i]);
        else if (out_close(&out[i], what, sizeof what) != 0)
            status = image_error(err, err_size, "%s: %s", path[i], what);
    }
    return status;
}
