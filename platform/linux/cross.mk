# What all Linux targets share that run in an emulator of user programs. Their
# conf.mk sets TRIPLET, TARGET_EMULATOR and TARGET_LIBC.
CC = $(TRIPLET)-gcc
CFLAGS ?= -O2
CPPFLAGS += -D_DEFAULT_SOURCE
LDFLAGS = -static
TARGET_SRC = platform/linux/linux.c
TARGET_RUN = $(TARGET_EMULATOR)
TARGET_TOOLS = $(CC) $(TARGET_EMULATOR)
TARGET_PACKAGES = gcc-$(TRIPLET) $(TARGET_LIBC) qemu-user
TARGET_FILES = yes
TARGET_PIXELS_MAX = 2073600
