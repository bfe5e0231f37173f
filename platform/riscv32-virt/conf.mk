# QEMU's RISC-V `virt` board without firmware: rv32imac, machine mode.
# sleep=off: or else minstret also counts time that the emulator slept.
CC = riscv64-unknown-elf-gcc
CFLAGS ?= -O2
ARCH_FLAGS = -march=rv32imac_zicsr -mabi=ilp32
CPPFLAGS += -Iplatform/bare
LDFLAGS = -nostdlib -Lplatform/bare -T platform/riscv32-virt/board.ld \
	-Wl,--gc-sections -Wl,--fatal-warnings
LDLIBS = -lgcc
TARGET_SRC = platform/riscv32-virt/startup.c $(addprefix platform/bare/,\
	semihosting.c print.c memory.c stack.c start.c)
TARGET_ASSETS_SRC = platform/bare/assets.S
TARGET_RUN = qemu-system-riscv32 -M virt -bios none -icount shift=0,sleep=off \
	-nographic -semihosting-config enable=on,target=native -kernel
TARGET_TOOLS = riscv64-unknown-elf-gcc qemu-system-riscv32
TARGET_PACKAGES = gcc-riscv64-unknown-elf qemu-system-misc
TARGET_FLASH = 16777216
TARGET_RAM = 16777216
TARGET_ASSETS_MAX = 16646144
