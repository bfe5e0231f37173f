# The default of `make CONF=`: programs of this machine.
HOST_SRC = $(filter-out %/wide_march.c,$(wildcard platform/host/*.c))
# The wide march is compiled once for each kind of lanes; all but the compiler's
# own vectors need flags, and x86-64.
WIDE = generic $(if $(filter x86_64-%,$(shell $(CC) -dumpmachine)),avx2 avx512)
WIDE_FLAGS_avx2 = -mavx2 -mbmi2
WIDE_FLAGS_avx512 = $(WIDE_FLAGS_avx2) -mavx512f -mavx512bw -mavx512dq \
	-mavx512vl -mavx512cd
