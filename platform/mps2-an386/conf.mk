# Arm MPS2 with AN386: Cortex-M4, the memory map of AN385.
BOARD = mps2-an386
TARGET_CPU = cortex-m4
include platform/mps2-an385/map.mk
include platform/cortexm/cortexm.mk
