# Linux on 64-bit Arm.
TRIPLET = aarch64-linux-gnu
TARGET_EMULATOR = qemu-aarch64
TARGET_LIBC = libc6-dev-arm64-cross
include platform/linux/cross.mk
