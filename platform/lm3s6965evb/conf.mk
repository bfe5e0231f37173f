# Stellaris LM3S6965 evaluation board: Cortex-M3, 256 KiB flash, 64 KiB RAM.
BOARD = lm3s6965evb
TARGET_CPU = cortex-m3
TARGET_FLASH = 262144
TARGET_RAM = 65536
TARGET_ASSETS_MAX = 135168
TARGET_STATE_BYTES = 0
include platform/cortexm/cortexm.mk
DEMO_SRC = platform/lm3s6965evb/demo.c platform/lm3s6965evb/oled.c \
	platform/demo/demo.c
DEMO_CLOUD = --size 112
DEMO_BAKE = --format u4r
