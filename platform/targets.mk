# Included for `make CONF=name` of a target: its test program, and the demo of a
# board. platform/NAME/conf.mk has given CC, flags and sources.
TARGET ?= $(CONF)
T = $(BUILD)/targets/$(TARGET)

all: ## (with CONF=name) the test program of a target
	@$(MAKE) --no-print-directory CONF=host $(TARGET_PROGRAMS)
	@BUILD=$(BUILD) DATA=$(DATA) sh tests/targets/run.sh build $(CONF)

demo: $(T)/demo.elf ## (with CONF=name, ASSET=file.brume) run a board's demo
	cd $(T) && $(TARGET_RUN) demo.elf

# Targets: a test program for CONF, in the folder TARGET (a variant's name). The
# file ASSETS lists what is linked in; TARGET_CONFIG is a BRUME_CONFIG header.
# TARGET_STATE_BYTES: of memory for sequences, 0 to leave them out.
TARGET_SIZE ?= size
TARGET_STATE_BYTES ?= 98304
# TARGET_WIDE: render by the wide kernel of hosts, in the compiler's vectors.
TARGET_WIDE_SRC = $(if $(TARGET_WIDE),tests/targets/wide_rect.c $(patsubst \
	%,platform/host/%.c,wide wide_march wide_copy pool))
TARGET_OBJ = $(patsubst %.c,$(T)/%.o,$(wildcard core/*.c) $(TARGET_SRC) \
	$(TARGET_WIDE_SRC) tests/targets/targets.c tests/support/scenes.c \
	tests/support/lighting.c) \
	$(patsubst %.S,$(T)/%.o,$(TARGET_ASSETS_SRC))
TARGET_CPPFLAGS = $(CPPFLAGS) -Iplatform -Itests $(TARGET_DEFINES) \
	$(if $(TARGET_CONFIG),-DBRUME_CONFIG='"targets/$(TARGET_CONFIG).h"') \
	$(if $(TARGET_WIDE),-DTARGET_WIDE -DWIDE_NAME=wide_march_generic) \
	$(if $(TARGET_PIXELS_MAX),-DTARGET_PIXELS_MAX=$(TARGET_PIXELS_MAX)) \
	-DTARGET_STATE_BYTES=$(TARGET_STATE_BYTES)
ifeq ($(findstring clang,$(CC)),)
STACK_USAGE = -fstack-usage -fcallgraph-info=su
endif

$(T)/targets.elf: $(TARGET_OBJ)
	$(CC) $(ARCH_FLAGS) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(LDLIBS)

$(T)/core/%.o: core/%.c platform/$(CONF)/conf.mk
	@mkdir -p $(@D)
	$(CC) $(ARCH_FLAGS) $(TARGET_CPPFLAGS) $(CORE_FLAGS) $(CFLAGS) \
		$(STACK_USAGE) -MMD -MP -c -o $@ $<

$(T)/%.o: %.c platform/$(CONF)/conf.mk
	@mkdir -p $(@D)
	$(CC) $(ARCH_FLAGS) $(TARGET_CPPFLAGS) -std=c11 -ffreestanding $(WARN) \
		$(CFLAGS) -MMD -MP -c -o $@ $<

$(T)/%.o: %.S $(ASSETS)
	@mkdir -p $(@D)
	$(CC) $(ARCH_FLAGS) -DTARGET_ASSETS='"$(abspath $(ASSETS))"' -c -o $@ $<

# What the laboratory counts there; the emulator loads volume and scenes.
COUNT_OBJ = $(patsubst %.c,$(T)/%.o,$(wildcard core/*.c) $(TARGET_SRC) \
	lab/target/count.c)

$(T)/count.elf: $(COUNT_OBJ)
	$(CC) $(ARCH_FLAGS) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(LDLIBS)

# A board's demo, on a cloud that it says how to make.
DEMO_OBJ = $(patsubst %.c,$(T)/demo/%.o,$(wildcard core/*.c) $(TARGET_SRC) \
	$(DEMO_SRC)) $(patsubst %.S,$(T)/demo/%.o,$(TARGET_ASSETS_SRC))

$(T)/demo.elf: $(DEMO_OBJ)
	$(CC) $(ARCH_FLAGS) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(LDLIBS)

$(T)/demo/%.o: %.c platform/$(CONF)/conf.mk
	@mkdir -p $(@D)
	$(CC) $(ARCH_FLAGS) $(CPPFLAGS) $(DEMO_CPPFLAGS) -std=c11 \
		-ffreestanding $(WARN) $(CFLAGS) -MMD -MP -c -o $@ $<

# ASSET, or the procedural cloud: its path is in asset.h, which changes with it.
DEMO_ASSET = $(abspath $(or $(ASSET),$(T)/demo/cloud.brume))

$(patsubst %.S,$(T)/demo/%.o,$(TARGET_ASSETS_SRC)): $(T)/demo/asset.h \
	$(DEMO_ASSET)
$(T)/demo/%.o: %.S
	@mkdir -p $(@D)
	$(CC) $(ARCH_FLAGS) -DTARGET_ASSETS='"$(abspath $(T)/demo/asset.h)"' \
		-c -o $@ $<

$(T)/demo/asset.h: FORCE
	@mkdir -p $(@D)
	@echo 'ASSET(cloud, "$(DEMO_ASSET)")' >$@.new
	@cmp -s $@.new $@ && rm $@.new || mv $@.new $@

$(abspath $(T))/demo/cloud.brume: platform/$(CONF)/conf.mk
	@mkdir -p $(@D)
	@$(MAKE) --no-print-directory CONF=host $(BUILD)/brume-cloud \
		$(BUILD)/brume-bake
	$(BUILD)/brume-cloud -o $(@D)/cloud.vdb $(DEMO_CLOUD)
	$(BUILD)/brume-bake $(@D)/cloud.vdb -o $@ $(DEMO_BAKE)

.PHONY: target-info FORCE
target-info: # for tests/targets/run.sh
	@echo "cc='$(CC)' flags='$(strip $(ARCH_FLAGS) $(CFLAGS))'"
	@echo "run='$(TARGET_RUN)' tools='$(TARGET_TOOLS)' size='$(TARGET_SIZE)'"
	@echo "packages='$(TARGET_PACKAGES)' files='$(TARGET_FILES)'"
	@echo "flash='$(TARGET_FLASH)' assets_max='$(TARGET_ASSETS_MAX)'"
	@echo "ram='$(TARGET_RAM)' demo='$(DEMO_SRC)'"
