/* SPDX-License-Identifier: MIT */
/*
 * A cloud on a BBC micro:bit, which has 16 KiB of RAM and no display: 80x60
 * grey pixels, in strips of two rows, to a picture file and as text on the
 * debugger's console.
 */
#include "demo/demo.h"
#include "target.h"

#define WIDTH 80
#define HEIGHT 60
#define ROWS 2 /* of a strip, and of a line of text */

static struct brume_volume s_volume;
static struct brume_frame s_frame;
static uint8_t s_strip[ROWS * WIDTH];

/* A character is about twice as high as wide: one for each pair of rows. */
static void write_as_text(const uint8_t *strip)
{
    static const char k_ramp[] = " .:-=+*#%@"; /* dark to bright */
    char line[WIDTH + 2];
    for (int x = 0; x < WIDTH; x++) {
        uint32_t grey = (uint32_t)strip[x] + strip[WIDTH + x];
        line[x] = k_ramp[grey * 10u >> 9];
    }
    line[WIDTH] = '\n';
    line[WIDTH + 1] = '\0';
    target_write(line);
}

static int draw(uint64_t *instructions, struct demo_picture *picture)
{
    for (unsigned y = 0; y < HEIGHT; y += ROWS) {
        int status =
            demo_strip(&s_frame, y, ROWS, BRUME_L8, s_strip, instructions);
        if (status == DEMO_OK)
            status = demo_picture_add(picture, s_strip, sizeof s_strip);
        if (status != DEMO_OK)
            return status;
        write_as_text(s_strip);
    }
    return demo_picture_end(picture);
}

int target_main(void)
{
    uint64_t instructions;
    struct demo_picture picture;
    struct brume_scene scene;
    int status = demo_open(&s_volume);
    if (status != DEMO_OK)
        return status;
    demo_scene(&scene, &s_volume, WIDTH, HEIGHT, -45);
    scene.background[0] = 655; /* 1 %: blank in the text */
    status = demo_begin(&s_frame, &s_volume, &scene, &instructions);
    if (status == DEMO_OK)
        status = demo_picture_begin(&picture, "microbit.pgm", 1, WIDTH, HEIGHT);
    if (status == DEMO_OK)
        status = draw(&instructions, &picture);
    if (status == DEMO_OK)
        demo_print("microbit: 80x60 L8, one frame", instructions);
    return status;
}
