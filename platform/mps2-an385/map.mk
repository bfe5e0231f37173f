# The memory map of AN385, which other images for the MPS2 board have too.
BOARD_MAP = mps2-an385
TARGET_FLASH = 4194304
TARGET_RAM = 4194304
TARGET_ASSETS_MAX = 4128768
