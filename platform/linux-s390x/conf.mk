# Linux on IBM Z, big-endian, 64 bits.
TRIPLET = s390x-linux-gnu
TARGET_EMULATOR = qemu-s390x
TARGET_LIBC = libc6-dev-s390x-cross
include platform/linux/cross.mk
