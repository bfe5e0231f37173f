# Netduino Plus 2: STM32F405, Cortex-M4, 1 MiB of flash, 128 KiB of RAM.
BOARD = netduinoplus2
TARGET_CPU = cortex-m4
TARGET_FLASH = 1048576
TARGET_RAM = 131072
TARGET_ASSETS_MAX = 884736
# Fewer clusters of lamps, which cannot be seen, fit this board's memory.
TARGET_DEFINES = -DBRUME_CLUSTER_SIDE=4 -DBRUME_CLUSTER_SLICES=2
TARGET_STATE_BYTES = 40960
include platform/cortexm/cortexm.mk
DEMO_SRC = platform/netduinoplus2/demo.c platform/demo/demo.c
DEMO_CLOUD = --size 160
DEMO_BAKE = --format u4r
