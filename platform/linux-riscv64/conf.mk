# Linux on 64-bit RISC-V.
TRIPLET = riscv64-linux-gnu
TARGET_EMULATOR = qemu-riscv64
TARGET_LIBC = libc6-dev-riscv64-cross
include platform/linux/cross.mk
