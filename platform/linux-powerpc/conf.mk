# Linux on PowerPC, big-endian, 32 bits.
TRIPLET = powerpc-linux-gnu
TARGET_EMULATOR = qemu-ppc
TARGET_LIBC = libc6-dev-powerpc-cross
include platform/linux/cross.mk
