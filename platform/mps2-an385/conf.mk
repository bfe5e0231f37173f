# Arm MPS2 with AN385: Cortex-M3, 4 MiB of code, 4 MiB of RAM.
BOARD = mps2-an385
TARGET_CPU = cortex-m3
TARGET_MACHINE = mps2-an385
TARGET_FLASH = 4194304
TARGET_RAM = 4194304
TARGET_ASSETS_MAX = 4128768
include platform/cortexm/cortexm.mk
