# Arm MPS2 with AN386: Cortex-M4, the memory map of AN385.
BOARD = mps2-an386
BOARD_MAP = mps2-an385
TARGET_CPU = cortex-m4
TARGET_MACHINE = mps2-an386
TARGET_FLASH = 4194304
TARGET_RAM = 4194304
TARGET_ASSETS_MAX = 4128768
include platform/cortexm/cortexm.mk
