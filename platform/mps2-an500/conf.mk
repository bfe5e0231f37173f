# Arm MPS2 with AN500: Cortex-M7, the memory map of AN385.
BOARD = mps2-an500
BOARD_MAP = mps2-an385
TARGET_CPU = cortex-m7
TARGET_MACHINE = mps2-an500
TARGET_FLASH = 4194304
TARGET_RAM = 4194304
TARGET_ASSETS_MAX = 4128768
include platform/cortexm/cortexm.mk
