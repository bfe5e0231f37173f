/* SPDX-License-Identifier: MIT */
/*
 * Lists as text: an item per line, `#` comments. An item is fields with spaces
 * between them; a field is a word, or numbers with commas between them:
 *
 *     1,2.5,-3 40 spot 0,-1,0
 *
 * What fields mean is up to who reads the list.
 *
 * Errors: as in image.h; messages start with file:line.
 */
#ifndef BRUME_HOST_LIST_FILE_H
#define BRUME_HOST_LIST_FILE_H

#include <stdbool.h>
#include <stddef.h>

#include "scene_file.h"

#define LIST_FIELDS 32 /* of an item at most */

struct list_item {
    char text[SCENE_LINE_SIZE]; /* its line, cut into fields */
    const char *field[LIST_FIELDS];
    size_t count; /* of fields, 1 at least */
    char where[SCENE_WHERE_SIZE];
};

struct list {
    struct list_item *item;
    size_t count;
};

#define LIST_BYTES (1u << 20) /* of a file at most, comments included */

/* Up to `most` items; a file with more is refused. `items` is what they are
 * called in messages. */
int list_read(struct list *list, const char *path, size_t most,
              const char *items, char *err, size_t err_size);
void list_free(struct list *list);

/* Is field number `i` there, and that word? */
bool list_is_word(const struct list_item *item, size_t i, const char *word);

/* The n numbers (4 at most) of field number `i`, each from min to max. `name`
 * is what the field is called in messages. */
int list_numbers(const struct list_item *item, size_t i, const char *name,
                 int n, double min, double max, double *out, char *err,
                 size_t err_size);

/* -1, and the message `where: what 'field i'`; of an item's end when there is
 * no such field. */
int list_fail(const struct list_item *item, size_t i, const char *what,
              char *err, size_t err_size);

#endif
