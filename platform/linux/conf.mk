# The test program of the targets, for this machine.
CC = gcc
CFLAGS ?= -O2
CPPFLAGS += -D_DEFAULT_SOURCE
TARGET_SRC = platform/linux/linux.c
TARGET_TOOLS = $(firstword $(CC))
TARGET_PACKAGES = gcc libc6-dev clang
TARGET_FILES = yes
TARGET_PIXELS_MAX = 2073600
# Names are bound at the start: bound at the first call, they take 2.5 KiB of
# the stack that is measured, where a processor has registers of 512 bits.
LDFLAGS += -Wl,-z,now
