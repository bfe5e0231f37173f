# Linux on 32-bit x86.
TRIPLET = i686-linux-gnu
TARGET_EMULATOR = qemu-i386
TARGET_LIBC = libc6-dev-i386-cross
include platform/linux/cross.mk
