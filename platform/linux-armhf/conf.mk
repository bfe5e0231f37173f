# Linux on 32-bit Arm with an FPU.
TRIPLET = arm-linux-gnueabihf
TARGET_EMULATOR = qemu-arm
TARGET_LIBC = libc6-dev-armhf-cross
include platform/linux/cross.mk
