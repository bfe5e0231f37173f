/* SPDX-License-Identifier: MIT */
/*
 * A cloud on a Netduino Plus 2 while the sun goes round: 160x120 RGB565 in
 * strips of eight rows, as one would send them to a panel. Here each frame
 * becomes a picture file on the debugger's side.
 */
#include "demo/demo.h"
#include "target.h"

#define WIDTH 160
#define HEIGHT 120
#define ROWS 8
#define FRAMES 6
#define SUN_FIRST (-80) /* degrees of azimuth; the camera is at 30 */
#define SUN_STEP 32

static struct brume_volume s_volume;
static struct brume_frame s_frame;
static uint16_t s_strip[ROWS * WIDTH];

/* A row as 8-bit red, green, blue: each field's top bits fill its low ones. */
static int add_row(struct demo_picture *picture, const uint16_t *row)
{
    uint8_t rgb[3 * WIDTH], *to = rgb;
    for (int x = 0; x < WIDTH; x++) {
        uint32_t r = row[x] >> 11, g = row[x] >> 5 & 63u, b = row[x] & 31u;
        *to++ = (uint8_t)(r << 3 | r >> 2);
        *to++ = (uint8_t)(g << 2 | g >> 4);
        *to++ = (uint8_t)(b << 3 | b >> 2);
    }
    return demo_picture_add(picture, rgb, sizeof rgb);
}

static int draw(uint64_t *instructions, struct demo_picture *picture)
{
    for (unsigned y = 0; y < HEIGHT; y += ROWS) {
        int status =
            demo_strip(&s_frame, y, ROWS, BRUME_RGB565, s_strip, instructions);
        for (int row = 0; row < ROWS && status == DEMO_OK; row++)
            status = add_row(picture, s_strip + row * WIDTH);
        if (status != DEMO_OK)
            return status;
    }
    return demo_picture_end(picture);
}

static int draw_frame(uint64_t *instructions, int number)
{
    char path[] = "netduinoplus2_0.ppm";
    struct demo_picture picture;
    struct brume_scene scene;
    path[14] = (char)('0' + number);
    demo_scene(&scene, &s_volume, WIDTH, HEIGHT, SUN_FIRST + number * SUN_STEP);
    scene.frame = (uint32_t)number;
    int status = demo_begin(&s_frame, &s_volume, &scene, instructions);
    if (status == DEMO_OK)
        status = demo_picture_begin(&picture, path, 3, WIDTH, HEIGHT);
    return status == DEMO_OK ? draw(instructions, &picture) : status;
}

int target_main(void)
{
    uint64_t instructions, most = 0;
    int status = demo_open(&s_volume);
    for (int i = 0; i < FRAMES && status == DEMO_OK; i++) {
        status = draw_frame(&instructions, i);
        if (status == DEMO_OK && instructions > most)
            most = instructions;
    }
    if (status == DEMO_OK)
        demo_print("netduinoplus2: 160x120 RGB565, the slowest of 6 frames",
                   most);
    return status;
}
