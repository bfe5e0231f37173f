# Arm MPS2 with AN385: Cortex-M3, 4 MiB of code, 4 MiB of RAM.
BOARD = mps2-an385
TARGET_CPU = cortex-m3
include platform/mps2-an385/map.mk
include platform/cortexm/cortexm.mk
