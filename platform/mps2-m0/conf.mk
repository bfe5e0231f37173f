# Cortex-M0 code with room: Armv6-M instructions run, and count, the same on the
# Cortex-M3 of AN385 (QEMU takes no other core there). For assets that are too
# large for the boards with a Cortex-M0.
BOARD = mps2-m0
TARGET_CPU = cortex-m0
TARGET_MACHINE = mps2-an385
include platform/mps2-an385/map.mk
include platform/cortexm/cortexm.mk
