# Linux on MIPS, big-endian, 32 bits.
TRIPLET = mips-linux-gnu
TARGET_EMULATOR = qemu-mips
TARGET_LIBC = libc6-dev-mips-cross
include platform/linux/cross.mk
