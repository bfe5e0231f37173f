# Arm MPS2 with AN505: Cortex-M33, secure, 4 MiB of code, 4 MiB of RAM.
BOARD = mps2-an505
TARGET_CPU = cortex-m33
TARGET_FLASH = 4194304
TARGET_RAM = 4194304
TARGET_ASSETS_MAX = 4128768
include platform/cortexm/cortexm.mk
