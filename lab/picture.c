/* SPDX-License-Identifier: MIT */
#include <stdlib.h>

#include "lab.h"

int lab_read_truth(const char *path, const struct image *picture,
                   struct image *to, char *err, size_t err_size)
{
    image_free(to);
    if (image_read(path, to, err, err_size) != 0)
        return 2;
    if (to->width == picture->width && to->height == picture->height &&
        to->channels == picture->channels)
        return 0;
    snprintf(err, err_size,
             "%.300s is %d x %d in %d channels, what it is for is %d x %d in "
             "%d",
             path, to->width, to->height, to->channels, picture->width,
             picture->height, picture->channels);
    return 2;
}

/// Rows ///

void lab_print_head(const struct lab_options *o, FILE *to)
{
    for (int i = 0; i < o->column_count; i++)
        fprintf(to, "%s,", o->columns[i].name);
    fprintf(to, "frame,reference,region,%s%s%s\n", lab_measure_names,
            o->flip ? ",flip" : "", o->time ? ",ms" : "");
}

int lab_print_row(const struct lab_options *o, FILE *to, uint32_t frame,
                  int reference, int region, const struct lab_pair *pair,
                  double ms, char *err, size_t err_size)
{
    for (int i = 0; i < o->column_count; i++)
        fprintf(to, "%s,", o->columns[i].value);
    fprintf(to, "%lu,%s,%s,", (unsigned long)frame,
            o->references[reference].name, o->regions[region].name);
    if (lab_measure(to, pair, &o->regions[region], err, err_size) != 0)
        return 2;
    if (o->time)
        fprintf(to, ",%.3f", ms);
    fputc('\n', to);
    return 0;
}

int lab_finish(FILE *rows, char **text, size_t *size, int status, bool print,
               char *err, size_t err_size)
{
    if (rows != NULL && fclose(rows) != 0 && status == 0) {
        snprintf(err, err_size, "not enough memory");
        status = 2;
    }
    if (status == 0 && print &&
        (fwrite(*text, 1, *size, stdout) != *size || fflush(stdout) != 0)) {
        snprintf(err, err_size, "cannot write the rows");
        status = 1;
    }
    free(*text);
    return status;
}

/// A picture ///

static int measure_all(const struct lab_options *o, const struct image *picture,
                       struct image *truth, FILE *rows, char *err,
                       size_t err_size)
{
    const struct lab_pair pair = {picture, truth, NULL, NULL, o->flip};
    int status = 0;
    for (int i = 0; status == 0 && i < o->reference_count; i++) {
        status = lab_read_truth(o->references[i].path, picture, truth, err,
                                err_size);
        for (int k = 0; status == 0 && k < o->region_count; k++)
            status =
                lab_print_row(o, rows, o->first, i, k, &pair, 0, err, err_size);
    }
    return status;
}

int lab_picture(const struct lab_options *o, char *err, size_t err_size)
{
    struct image picture = {0}, truth = {0};
    char *text = NULL;
    size_t size = 0;
    FILE *rows = open_memstream(&text, &size);
    int status = 2;
    if (rows == NULL) {
        snprintf(err, err_size, "not enough memory");
    } else if (image_read(o->volume, &picture, err, err_size) == 0) {
        lab_print_head(o, rows);
        status = measure_all(o, &picture, &truth, rows, err, err_size);
    }
    image_free(&picture);
    image_free(&truth);
    return lab_finish(rows, &text, &size, status, true, err, err_size);
}
