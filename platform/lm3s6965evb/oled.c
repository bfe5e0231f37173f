/* SPDX-License-Identifier: MIT */
/*
 * The OLED: an SSD0323 controller on SSI0. Port C pin 7 tells data (1) from
 * commands (0), port D pin 0 selects it, high, as QEMU wires the board. By
 * the data sheets of the LM3S6965 and the SSD0323.
 */
#include "oled.h"

#include <stdbool.h>

#define REGISTER(address) (*(volatile uint32_t *)(address))

#define RCGC1 REGISTER(0x400fe104u) /* clock of SSI0: bit 4 */
#define RCGC2 \
    REGISTER(0x400fe108u) /* clocks of ports A, C, D: bits 0, 2, 3 \
                           */

#define PORT_A 0x40004000u
#define PORT_C 0x40006000u
#define PORT_D 0x40007000u
#define GPIO_DATA(port, pins) REGISTER((port) + ((pins) << 2))
#define GPIO_DIRECTION(port) REGISTER((port) + 0x400u)
#define GPIO_ALTERNATE(port) REGISTER((port) + 0x420u)
#define GPIO_DIGITAL(port) REGISTER((port) + 0x51cu)

#define SSI_CR0 REGISTER(0x40008000u)
#define SSI_CR1 REGISTER(0x40008004u)
#define SSI_DATA REGISTER(0x40008008u)
#define SSI_STATUS REGISTER(0x4000800cu)
#define SSI_PRESCALE REGISTER(0x40008010u)

#define PIN_DATA 0x80u   /* port C */
#define PIN_SELECT 0x01u /* port D */
#define PINS_SSI 0x24u   /* port A: clock 2, output 5 */

#define CR0_MODE_3_8_BITS 0xc7u
#define CR1_ENABLE 0x02u
#define STATUS_BUSY 0x10u

static void output_pin(uint32_t port, uint32_t pin)
{
    GPIO_DIRECTION(port) |= pin;
    GPIO_DIGITAL(port) |= pin;
}

static void send(bool data, const uint8_t *bytes, uint32_t size)
{
    GPIO_DATA(PORT_C, PIN_DATA) = data ? PIN_DATA : 0;
    for (uint32_t i = 0; i < size; i++) {
        SSI_DATA = bytes[i];
        while (SSI_STATUS & STATUS_BUSY) {
        }
        (void)SSI_DATA; /* what came back: a full queue would stop it */
    }
}

void oled_begin(void)
{
    static const uint8_t k_set_up[] = {
        0xae,       /* off */
        0xa0, 0x52, /* order of pixels: rows, the left one high */
        0xa1, 0x00, /* first row */
        0xa8, 0x3f, /* 64 rows */
        0x81, 0x60, /* contrast */
        0xa4,       /* shows its memory */
        0xaf        /* on */
    };
    RCGC1 |= 1u << 4;
    RCGC2 |= 1u << 0 | 1u << 2 | 1u << 3;
    (void)RCGC2; /* clocks take three cycles to come */
    GPIO_ALTERNATE(PORT_A) |= PINS_SSI;
    GPIO_DIGITAL(PORT_A) |= PINS_SSI;
    output_pin(PORT_C, PIN_DATA);
    output_pin(PORT_D, PIN_SELECT);
    GPIO_DATA(PORT_D, PIN_SELECT) = PIN_SELECT;
    SSI_CR1 = 0;
    SSI_PRESCALE = 4; /* 3 MHz of 12.5 */
    SSI_CR0 = CR0_MODE_3_8_BITS;
    SSI_CR1 = CR1_ENABLE;
    send(false, k_set_up, sizeof k_set_up);
}

void oled_rows(unsigned y, unsigned rows, const uint8_t *pixels)
{
    uint8_t window[6] = {
        0x15, 0,          OLED_WIDTH / 2 - 1, /* columns of a byte */
        0x75, (uint8_t)y, (uint8_t)(y + rows - 1u)};
    send(false, window, sizeof window);
    send(true, pixels, rows * (OLED_WIDTH / 2));
}
