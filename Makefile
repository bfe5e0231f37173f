# brume: `make help` lists the targets.
#
#   BUILD=dir   where everything goes           CONF=name  platform/name/conf.mk
#   CC CXX CFLAGS CXXFLAGS LDFLAGS              compilers and their flags
#   PREFIX DESTDIR                              of `make install`
#   VDB=file                                    the volume of `make demo`
#   DATA=dir                                    real volumes for the tests
BUILD ?= build
CONF ?= host
PREFIX ?= /usr/local
DATA ?= ../shared/data
JOBS ?= $(shell nproc 2>/dev/null || echo 2)

ifeq ($(wildcard platform/$(CONF)/conf.mk),)
$(error CONF=$(CONF): there is no platform/$(CONF)/conf.mk)
endif
include platform/$(CONF)/conf.mk
ifneq ($(CONF),host)
include platform/targets.mk
endif
CFLAGS ?= -O3
CXXFLAGS ?= -O2
CPPFLAGS += -Icore
WARN = -Wall -Wextra -Wshadow -Wconversion -Werror
CORE_FLAGS = -std=c99 -ffreestanding $(WARN)
# Contraction would give doubles, and what is made of them, other last bits.
HOST_FLAGS = -std=c11 -D_POSIX_C_SOURCE=200809L -ffp-contract=off $(WARN)
CONVERT_FLAGS = -std=c++17 -ffp-contract=off -Wall -Wextra -Wshadow -Werror \
	-DNANOVDB_USE_BLOSC -DNANOVDB_USE_ZIP
CONVERT_LIBS = -lopenvdb -ltbb -lImath -lblosc -lz -lpthread
PACKAGES = gcc g++ libc6-dev libopenvdb-dev libnanovdb-dev libboost-dev \
	libblosc-dev zlib1g-dev
TEST_PACKAGES = $(PACKAGES) clang libclang-rt-14-dev binutils netpbm pngcheck

CORE_OBJ = $(patsubst core/%.c,$(BUILD)/core/%.o,$(wildcard core/*.c))
TABLE_OBJ = $(patsubst %.c,$(BUILD)/%.o,$(wildcard tables/noise_*.c))
NOISE_OBJ = $(patsubst %.c,$(BUILD)/%.o,\
	$(filter-out %_main.c,$(wildcard tables/noise/*.c)))
HOST_OBJ = $(patsubst platform/%.c,$(BUILD)/%.o,$(HOST_SRC)) \
	$(WIDE:%=$(BUILD)/host/wide_march_%.o)
CONVERT_OBJ = $(patsubst convert/%.cpp,$(BUILD)/convert/%.o,\
	$(filter-out %_main.cpp,$(wildcard convert/*.cpp)))
REFERENCE_OBJ = $(patsubst tests/%.cpp,$(BUILD)/tests/%.o,\
	$(filter-out %_main.cpp,$(wildcard tests/reference/*.cpp)))
STABILITY_OBJ = $(patsubst tests/%.c,$(BUILD)/tests/%.o,\
	$(wildcard tests/stability/*.c))
TEST_LIB_OBJ = $(patsubst tests/%.c,$(BUILD)/tests/%.o,\
	$(wildcard tests/support/*.c)) $(filter-out %/main.o,$(HOST_OBJ))
TESTS = $(patsubst tests/%.c,$(BUILD)/tests/%,$(wildcard tests/test_*.c)) \
	$(patsubst tests/%.cpp,$(BUILD)/tests/%,$(wildcard tests/test_*.cpp))
PROGRAMS = $(BUILD)/brume $(BUILD)/brume-bake $(BUILD)/brume-cloud \
	$(BUILD)/brume-noise
TARGET_PROGRAMS = $(PROGRAMS) $(BUILD)/tests/hash_scenes
REFERENCES = reference spec-dump monte-carlo octave-fit
TEST_PROGRAMS = $(TESTS) $(REFERENCES:%=$(BUILD)/brume-%) \
	$(BUILD)/tests/hash_scenes $(BUILD)/tests/section_dump \
	$(BUILD)/tests/make_vdbs $(BUILD)/tests/noise_march \
	$(BUILD)/brume-stability $(BUILD)/brume-lab $(BUILD)/brume-atlas \
	$(BUILD)/brume-papers

.PHONY: all demo test golden targets targets-update targets-deps deps \
	test-deps install clean help
.DELETE_ON_ERROR:

ifeq ($(CONF),host)
all: $(PROGRAMS) ## build the programs

demo: deps ## make a cloud (or take VDB=file), bake it, draw pictures of it
	@$(MAKE) --no-print-directory -j$(JOBS) all
	@BUILD=$(BUILD) VDB="$(VDB)" sh platform/host/demo.sh
include bench/bench.mk
include lab/lab.mk
include lab/atlas/atlas.mk
endif

test: test-deps ## build and run every test of this machine
	@$(MAKE) --no-print-directory -j$(JOBS) all $(TEST_PROGRAMS)
	@BUILD=$(BUILD) DATA=$(DATA) CC="$(CC)" sh tests/run.sh

golden: $(PROGRAMS) $(TEST_PROGRAMS) ## renew the golden pictures and hashes
	@BUILD=$(BUILD) DATA=$(DATA) sh tests/golden.sh update

targets: targets-deps ## one image on every target: build, run, compare, table
	@$(MAKE) --no-print-directory -j$(JOBS) $(TARGET_PROGRAMS)
	@BUILD=$(BUILD) DATA=$(DATA) JOBS=$(JOBS) sh tests/targets/run.sh

targets-update: $(TARGET_PROGRAMS) ## renew counts.txt and docs/TARGETS.md
	@BUILD=$(BUILD) DATA=$(DATA) JOBS=$(JOBS) sh tests/targets/run.sh update

deps: ## install the packages that the programs need, if any is missing
	@sh platform/host/deps.sh $(PACKAGES)

test-deps: ## the same for the tests
	@sh platform/host/deps.sh $(TEST_PACKAGES)

targets-deps: ## the same for the targets: cross compilers and emulators
	@sh platform/host/deps.sh $$(sh tests/targets/run.sh packages)

install: $(PROGRAMS) $(BUILD)/libbrume.a ## to PREFIX
	install -d $(DESTDIR)$(PREFIX)/bin $(DESTDIR)$(PREFIX)/include \
		$(DESTDIR)$(PREFIX)/lib
	install $(PROGRAMS) $(DESTDIR)$(PREFIX)/bin
	install -m 644 core/brume.h tables/brume_noise_tables.h \
		$(DESTDIR)$(PREFIX)/include
	install -m 644 $(BUILD)/libbrume.a $(DESTDIR)$(PREFIX)/lib

clean: ## remove what was built
	rm -rf $(BUILD)

help: ## this list
	@sed -n 's/^\([a-z-]*\):.*## /  make \1|/p' Makefile platform/targets.mk \
		bench/bench.mk lab/lab.mk | \
		awk -F'|' '{ printf "%-21s %s\n", $$1, $$2 }'

# Programs
$(BUILD)/brume: $(HOST_OBJ) $(BUILD)/libbrume.a
	$(CC) $(LDFLAGS) -o $@ $^ -lm -lpthread

$(BUILD)/libbrume.a: $(CORE_OBJ) $(TABLE_OBJ)
	rm -f $@
	$(AR) rcs $@ $^

$(BUILD)/libconvert.a: $(CONVERT_OBJ)
	rm -f $@
	$(AR) rcs $@ $^

$(BUILD)/brume-%: $(BUILD)/convert/%_main.o $(BUILD)/libconvert.a
	$(CXX) $(LDFLAGS) -o $@ $^ $(CONVERT_LIBS)

$(BUILD)/brume-noise: $(BUILD)/tables/noise/noise_main.o $(NOISE_OBJ) \
		$(filter-out %/main.o,$(HOST_OBJ)) $(BUILD)/libbrume.a
	$(CC) $(LDFLAGS) -o $@ $^ -lm -lpthread

.SECONDEXPANSION:
$(REFERENCES:%=$(BUILD)/brume-%): $(BUILD)/brume-%: \
		$(BUILD)/tests/reference/$$(subst -,_,$$*)_main.o $(REFERENCE_OBJ)
	$(CXX) $(LDFLAGS) -o $@ $^ -lpthread

$(BUILD)/brume-stability: $(STABILITY_OBJ) $(TEST_LIB_OBJ) \
		$(BUILD)/libbrume.a
	$(CC) $(LDFLAGS) -o $@ $^ -lm -lpthread

# Tests
$(BUILD)/tests/hash_scenes: $(BUILD)/tests/hash_scenes.o $(TEST_LIB_OBJ) \
		$(BUILD)/libbrume.a
	$(CC) $(LDFLAGS) -o $@ $^ -lm -lpthread

$(BUILD)/tests/noise_march: $(BUILD)/tests/noise_march.o $(TEST_LIB_OBJ) \
		$(BUILD)/libbrume.a
	$(CC) $(LDFLAGS) -o $@ $^ -lm -lpthread

$(BUILD)/tests/section_dump: $(BUILD)/tests/section_dump.o
	$(CC) $(LDFLAGS) -o $@ $^ -lm

$(BUILD)/tests/make_vdbs: tests/make_vdbs.cpp
	@mkdir -p $(@D)
	$(CXX) $(CONVERT_FLAGS) $(CXXFLAGS) $(LDFLAGS) -o $@ $< $(CONVERT_LIBS)

$(BUILD)/tests/test_%: $(BUILD)/tests/test_%.o $(TEST_LIB_OBJ) \
		$(NOISE_OBJ) $(REFERENCE_OBJ) $(BUILD)/libbrume.a
	$(CXX) $(LDFLAGS) -o $@ $^ -lm -lpthread

# Objects
$(BUILD)/core/%.o: core/%.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) $(CORE_FLAGS) $(CFLAGS) -MMD -MP -c -o $@ $<

$(BUILD)/tables/noise/%.o: tables/noise/%.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) -Iplatform/host $(HOST_FLAGS) $(CFLAGS) \
		-MMD -MP -c -o $@ $<

$(BUILD)/tables/%.o: tables/%.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) $(CORE_FLAGS) $(CFLAGS) -MMD -MP -c -o $@ $<

$(WIDE:%=$(BUILD)/host/wide_march_%.o): $(BUILD)/host/wide_march_%.o: \
		platform/host/wide_march.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) $(HOST_FLAGS) $(CFLAGS) $(WIDE_FLAGS_$*) \
		-DWIDE_NAME=wide_march_$* -MMD -MP -c -o $@ $<

$(BUILD)/host/%.o: platform/host/%.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) -Itables $(HOST_FLAGS) $(CFLAGS) -MMD -MP -c -o $@ $<

$(BUILD)/convert/%.o: convert/%.cpp
	@mkdir -p $(@D)
	$(CXX) $(CPPFLAGS) $(CONVERT_FLAGS) $(CXXFLAGS) -MMD -MP -c -o $@ $<

$(BUILD)/tests/%.o: tests/%.cpp
	@mkdir -p $(@D)
	$(CXX) $(CPPFLAGS) -Itests -Itests/reference -std=c++17 $(WARN) \
		$(CXXFLAGS) -MMD -MP -c -o $@ $<

$(BUILD)/tests/%.o: tests/%.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) -Itests -Itables -Itables/noise -Iplatform/host \
		$(HOST_FLAGS) $(CFLAGS) -MMD -MP -c -o $@ $<

.SECONDARY:
-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)
