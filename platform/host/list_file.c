/* SPDX-License-Identifier: MIT */
#include "list_file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "scene_keys.h"

#define LIST_NUMBERS 4 /* of a field */

int list_fail(const struct list_item *item, size_t i, const char *what,
              char *err, size_t err_size)
{
    if (i < item->count)
        snprintf(err, err_size, "%s: %s, not '%.40s'", item->where, what,
                 item->field[i]);
    else
        snprintf(err, err_size, "%s: %s, not the line's end", item->where,
                 what);
    return -1;
}

/// Reading ///

static int split(struct list_item *item, char *err, size_t err_size)
{
    char *text = item->text;
    item->count = 0;
    for (;;) {
        text += strspn(text, " \t");
        if (*text == '\0')
            return 0;
        if (item->count == LIST_FIELDS) {
            snprintf(err, err_size, "%s: more than %d fields in a line",
                     item->where, LIST_FIELDS);
            return -1;
        }
        item->field[item->count++] = text;
        text += strcspn(text, " \t");
        if (*text != '\0')
            *text++ = '\0';
    }
}

/* A line of the file: into the item, which has no fields when it is empty. */
static int read_item(struct list_item *item, char *line, const char *path,
                     unsigned number, char *err, size_t err_size)
{
    snprintf(item->where, sizeof item->where, "%.250s:%u", path, number);
    item->count = 0;
    if (scene_check_line(line, item->where, err, err_size) != 0)
        return -1;
    strcpy(item->text, scene_trimmed(line));
    return split(item, err, err_size);
}

static int read_items(struct list *list, FILE *f, const char *path, size_t most,
                      const char *items, char *err, size_t err_size)
{
    char line[SCENE_LINE_SIZE + 1];
    for (unsigned n = 1; scene_next_line(f, line); n++) {
        /* one more than may be, to see what would be too many */
        struct list_item *item = &list->item[list->count];
        if (read_item(item, line, path, n, err, err_size) != 0)
            return -1;
        if (ftell(f) > (long)LIST_BYTES) {
            snprintf(err, err_size, "%s: more than %u bytes", item->where,
                     LIST_BYTES);
            return -1;
        }
        if (item->count > 0 && list->count == most) {
            snprintf(err, err_size, "%s: more than %zu %s", item->where, most,
                     items);
            return -1;
        }
        list->count += item->count > 0;
    }
    if (ferror(f)) {
        snprintf(err, err_size, "%s: %s", path, strerror(errno));
        return -1;
    }
    return 0;
}

/* Fields point into their own item: no item moves once it is read. */
int list_read(struct list *list, const char *path, size_t most,
              const char *items, char *err, size_t err_size)
{
    FILE *f = fopen(path, "r");
    list->count = 0;
    list->item = NULL;
    if (f == NULL) {
        snprintf(err, err_size, "%s: %s", path, strerror(errno));
        return -1;
    }
    int result = -1;
    list->item = calloc(most + 1, sizeof *list->item);
    if (list->item == NULL)
        snprintf(err, err_size, "%s: no memory", path);
    else
        result = read_items(list, f, path, most, items, err, err_size);
    fclose(f);
    if (result != 0)
        list_free(list);
    return result;
}

void list_free(struct list *list)
{
    free(list->item);
    list->item = NULL;
    list->count = 0;
}

/// Fields ///

bool list_is_word(const struct list_item *item, size_t i, const char *word)
{
    return i < item->count && strcmp(item->field[i], word) == 0;
}

int list_numbers(const struct list_item *item, size_t i, const char *name,
                 int n, double min, double max, double *out, char *err,
                 size_t err_size)
{
    static const char *const k_numbers[LIST_NUMBERS] = {
        "a number", "two numbers x,y", "three numbers x,y,z",
        "four numbers x,y,z,w"};
    char what[100];
    snprintf(what, sizeof what, "%.60s is %s", name, k_numbers[n - 1]);
    if (i >= item->count ||
        scene_read_numbers(item->field[i], out, n, '\0') != n)
        return list_fail(item, i, what, err, err_size);
    for (int c = 0; c < n; c++)
        if (out[c] < min || out[c] > max) {
            snprintf(err, err_size, "%s: %s is %g, outside %g to %g",
                     item->where, name, out[c], min, max);
            return -1;
        }
    return 0;
}
