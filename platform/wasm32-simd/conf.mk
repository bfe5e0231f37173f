# WebAssembly with 128-bit vectors, which compilers may use as they like.
ARCH_FLAGS = --target=wasm32 -msimd128
CFLAGS ?= -O3
include platform/wasm32/conf.mk
