/* SPDX-License-Identifier: MIT */
/*
 * What a panel shows: pixels in the core's formats, back to 8 bits a channel.
 */
#ifndef BRUME_HOST_PANEL_H
#define BRUME_HOST_PANEL_H

#include "brume.h"
#include "image.h"

/* Names, separated by spaces. */
extern const char panel_names[];

/* The core's pixel format of a name; -1 when there is none. */
int panel_format(const char *name);

/* 1 grey, 3 RGB, 4 RGBA. */
int panel_channels(int pixel_format);

/* Fills an image of that many channels from rows of brume_row_bytes each. Alpha
 * is no longer premultiplied then, as PNG wants it. */
void panel_expand(int pixel_format, const void *from, struct image *to);

#endif
