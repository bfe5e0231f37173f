# Arm MPS2 with AN500: Cortex-M7, the memory map of AN385.
BOARD = mps2-an500
TARGET_CPU = cortex-m7
include platform/mps2-an385/map.mk
include platform/cortexm/cortexm.mk
