# Linux on Motorola 68020, big-endian, 32 bits.
TRIPLET = m68k-linux-gnu
TARGET_EMULATOR = qemu-m68k
TARGET_LIBC = libc6-dev-m68k-cross
include platform/linux/cross.mk
