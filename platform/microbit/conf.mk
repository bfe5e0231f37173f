# BBC micro:bit: nRF51822, Cortex-M0, 256 KiB of flash, 16 KiB of RAM.
BOARD = microbit
TARGET_CPU = cortex-m0
TARGET_FLASH = 262144
TARGET_RAM = 16384
TARGET_ASSETS_MAX = 135168
TARGET_STATE_BYTES = 0
include platform/cortexm/cortexm.mk
DEMO_SRC = platform/microbit/demo.c platform/demo/demo.c
DEMO_CLOUD = --size 112
DEMO_BAKE = --format u4r
