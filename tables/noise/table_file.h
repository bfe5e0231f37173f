/* SPDX-License-Identifier: MIT */
/* Textures as pictures and as C. */
#ifndef BRUME_TABLES_TABLE_FILE_H
#define BRUME_TABLES_TABLE_FILE_H

#include "space.h"

/* A file of the kind that the path's extension says: .png (frames below each
 * other), .raw or .c. The C form is `const struct brume_noise_table`, or for
 * directions `const struct brume_direction_table`, named brume_ and the file's
 * name; `command` becomes its line 1. bits is 4 or 8. Points have no C form.
 * Returns 0, or -1 with one line of text in err and no partial file. */
int table_file_write(const struct noise_texture *t, enum noise_space space,
                     const char *path, uint32_t bits, const char *command,
                     char *err, size_t err_size);

/* Whether table_file_write can write such a path; the reason when not. */
int table_file_check(const char *path, enum noise_space space, char *err,
                     size_t err_size);

#endif
