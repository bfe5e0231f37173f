/* SPDX-License-Identifier: MIT */
/*
 * A cloud on the OLED of the LM3S6965 evaluation board: 128x64 pixels in
 * strips of eight rows, dithered to 16 greys. Afterwards the picture stays,
 * when the command line says so ("hold", see screenshot.sh); or else the
 * program ends.
 */
#include "demo/demo.h"
#include "target.h"
#include "oled.h"
#include "semihosting.h"

#define ROWS 8

static struct brume_volume s_volume;
static struct brume_frame s_frame;
static uint8_t s_strip[ROWS * OLED_WIDTH];

/* Grey of 8 bits -> 0 .. 15, by a threshold of Bayer's 4x4 matrix. */
static uint32_t dithered(uint32_t grey, unsigned x, unsigned y)
{
    static const uint8_t k_bayer[4][4] = {
        {0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};
    /* grey * 15 / 255 is grey / 17; thresholds are the middles of sixteenths
     * of 17, so 0 and 255 stay what they are. */
    return (grey * 32u + (k_bayer[y & 3][x & 3] * 2u + 1u) * 17u) / (32u * 17u);
}

/* Packs the strip in place: two pixels a byte. */
static void pack(unsigned y)
{
    for (unsigned i = 0; i < ROWS * OLED_WIDTH / 2; i++) {
        unsigned x = 2 * i % OLED_WIDTH, row = y + 2 * i / OLED_WIDTH;
        uint32_t left = dithered(s_strip[2 * i], x, row);
        uint32_t right = dithered(s_strip[2 * i + 1], x + 1, row);
        s_strip[i] = (uint8_t)(left << 4 | right);
    }
}

static int draw(uint64_t *instructions)
{
    int status = DEMO_OK;
    for (unsigned y = 0; y < OLED_HEIGHT && status == DEMO_OK; y += ROWS) {
        status = demo_strip(&s_frame, y, ROWS, BRUME_L8, s_strip, instructions);
        pack(y);
        if (status == DEMO_OK)
            oled_rows(y, ROWS, s_strip);
    }
    return status;
}

int target_main(void)
{
    uint64_t instructions;
    struct brume_scene scene;
    int status = demo_open(&s_volume);
    if (status != DEMO_OK)
        return status;
    demo_scene(&scene, &s_volume, OLED_WIDTH, OLED_HEIGHT, -45);
    scene.background[0] = 0; /* pixels that do not light */
    oled_begin();
    status = demo_begin(&s_frame, &s_volume, &scene, &instructions);
    if (status == DEMO_OK)
        status = draw(&instructions);
    if (status != DEMO_OK)
        return status;
    demo_print("lm3s6965evb: 128x64 in 16 greys, one frame", instructions);
    semihosting_hold("hold");
    return DEMO_OK;
}
