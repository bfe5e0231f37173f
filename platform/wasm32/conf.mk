# WebAssembly without a system: clang and wasm-ld, run by Node.js.
CC = clang
CFLAGS ?= -O2
ARCH_FLAGS ?= --target=wasm32
LDFLAGS = -nostdlib -Wl,--no-entry -Wl,--gc-sections -Wl,-z,stack-size=65536
TARGET_SRC = platform/wasm32/wasm.c
TARGET_RUN = node platform/wasm32/run.mjs
TARGET_TOOLS = clang wasm-ld node llvm-size
TARGET_SIZE = llvm-size
TARGET_PACKAGES = clang lld llvm nodejs
TARGET_FILES = yes
TARGET_PIXELS_MAX = 2073600
