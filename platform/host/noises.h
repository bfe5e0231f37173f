/* SPDX-License-Identifier: MIT */
/*
 * The noises of a scene by name: those of the core, the committed tables, and
 * tables read from files.
 */
#ifndef BRUME_HOST_NOISES_H
#define BRUME_HOST_NOISES_H

#include "brume.h"

/* Separated by spaces; a name's number is its place, from 0. */
extern const char noise_words[];

/* Sets the scene's noise and noise_table to the noise of that number. */
void noise_choose(unsigned number, struct brume_scene *scene);

/* The number of a scene's noise; that of none when it is from a file. */
unsigned noise_number(const struct brume_scene *scene);

/* Does the text name a file of values, NAME.WxHxT.raw? */
bool noise_is_file(const char *text);

/* Reads one: a byte per value, x fastest, then y, then frame, sides powers of
 * two. It stays for the life of the program, as scenes point to it. Returns
 * NULL with one line of text in err. */
const struct brume_noise_table *noise_read(const char *path, char *err,
                                           size_t err_size);

#endif
