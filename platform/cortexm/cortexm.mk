# What all Cortex-M boards share. A board's conf.mk sets BOARD (its folder),
# BOARD_MAP (the folder of its board.h and board.ld, if another), TARGET_CPU,
# TARGET_MACHINE (QEMU's name, if another) and the sizes. sleep=off: time moves
# with instructions alone.
BOARD_MAP ?= $(BOARD)
TARGET_MACHINE ?= $(BOARD)
CC = arm-none-eabi-gcc
CFLAGS ?= -O2
ARCH_FLAGS = -mcpu=$(TARGET_CPU) -mthumb -mfloat-abi=soft
CPPFLAGS += -Iplatform/bare -Iplatform/$(BOARD_MAP)
LDFLAGS = -nostdlib -Lplatform/bare -T platform/$(BOARD_MAP)/board.ld \
	-Wl,--gc-sections -Wl,--fatal-warnings
LDLIBS = -lgcc
TARGET_SRC = platform/cortexm/startup.c $(addprefix platform/bare/,\
	semihosting.c print.c memory.c stack.c start.c)
TARGET_ASSETS_SRC = platform/bare/assets.S
TARGET_RUN = qemu-system-arm -M $(TARGET_MACHINE) -icount shift=0,sleep=off \
	-nographic -semihosting-config enable=on,target=native -kernel
TARGET_TOOLS = arm-none-eabi-gcc qemu-system-arm
TARGET_PACKAGES = gcc-arm-none-eabi qemu-system-arm
DEMO_CPPFLAGS = -DBRUME_CONFIG='"brume_config.h"' -Iplatform \
	-ffunction-sections -fdata-sections
