# Arm MPS3 with AN547: Cortex-M55, secure, 512 KiB of code, 512 KiB of RAM,
# assets in 16 MiB of the DDR.
BOARD = mps3-an547
TARGET_CPU = cortex-m55
TARGET_FLASH = 524288
TARGET_RAM = 524288
TARGET_ASSETS_MAX = 16777216
include platform/cortexm/cortexm.mk
