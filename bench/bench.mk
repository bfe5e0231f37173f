# The benchmark: peers with the same work in the same run. Included by the
# Makefile for CONF=host. The row of VTK is built where libvtk9-dev is there.
.PHONY: bench bench-update bench-deps

BENCH_PACKAGES = $(PACKAGES) gnuplot-nox libopenvdb-tools
BENCH_OBJ = $(patsubst bench/%,$(BUILD)/bench/%.o,$(filter-out \
	bench/limit.c bench/layouts% bench/vtk.cpp,$(wildcard bench/*.c bench/*.cpp)))
BENCH_FAST = -O3 -march=native -ffast-math
BENCH_PROGRAMS = $(BUILD)/brume-bench $(BUILD)/brume-limit
# Of x86-64: once for each kind of lanes.
LAYOUTS = $(filter-out generic,$(WIDE))
LAYOUTS_OBJ = $(patsubst %,$(BUILD)/bench/%.c.o,layouts_main layouts_make \
	ours count) $(LAYOUTS:%=$(BUILD)/bench/layouts_%.o)
ifneq ($(LAYOUTS),)
BENCH_PROGRAMS += $(BUILD)/brume-layouts
endif
VTK = /usr/include/vtk-9.1
VTK_LIBS = $(patsubst %,-lvtk%-9.1,RenderingVolume RenderingVolumeOpenGL2 \
	RenderingOpenGL2 RenderingCore CommonDataModel CommonExecutionModel \
	CommonCore)
ifneq ($(wildcard $(VTK)/vtkFixedPointVolumeRayCastMapper.h),)
BENCH_PROGRAMS += $(BUILD)/brume-vtk
endif

bench: bench-deps ## the peers, how it scales, the machine's limit (PART=...)
	@$(MAKE) --no-print-directory -j$(JOBS) all $(BENCH_PROGRAMS)
	@BUILD=$(BUILD) DATA=$(DATA) sh bench/run.sh $(PART)

bench-update: bench-deps ## the same into docs/BENCH.md and docs/bench
	@$(MAKE) --no-print-directory -j$(JOBS) all $(BENCH_PROGRAMS)
	@BUILD=$(BUILD) DATA=$(DATA) sh bench/run.sh update

bench-deps: ## packages for the benchmark: peers and charts
	@sh platform/host/deps.sh $(BENCH_PACKAGES)

$(BUILD)/brume-bench: $(BENCH_OBJ) $(REFERENCE_OBJ) \
		$(filter-out %/main.o,$(HOST_OBJ)) $(BUILD)/libbrume.a
	$(CXX) $(LDFLAGS) -o $@ $^ $(CONVERT_LIBS) -lm

$(BUILD)/brume-limit: $(BUILD)/bench/limit.c.o
	$(CC) $(LDFLAGS) -o $@ $^ -lpthread

$(BUILD)/brume-layouts: $(LAYOUTS_OBJ) $(filter-out %/main.o,$(HOST_OBJ)) \
		$(BUILD)/libbrume.a
	$(CC) $(LDFLAGS) -o $@ $^ -lm -lpthread

$(LAYOUTS:%=$(BUILD)/bench/layouts_%.o): $(BUILD)/bench/layouts_%.o: \
		bench/layouts.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) -Iplatform/host $(HOST_FLAGS) $(CFLAGS) \
		$(WIDE_FLAGS_$*) -DLAYOUTS_RUN=layouts_run_$* -MMD -MP -c -o $@ $<

$(BUILD)/brume-vtk: bench/vtk.cpp
	@mkdir -p $(@D)
	$(CXX) -std=c++17 -O3 -Wall -Wextra -isystem $(VTK) $(LDFLAGS) -o $@ $< \
		$(VTK_LIBS) $(CONVERT_LIBS)

# Peers with the flags that a package has, and with all that this machine has.
$(BUILD)/bench/nano_tuned.cpp.o $(BUILD)/bench/pnano.cpp.o: \
	private BENCH_FLAGS = $(BENCH_FAST)

$(BUILD)/bench/%.cpp.o: bench/%.cpp
	@mkdir -p $(@D)
	$(CXX) $(CPPFLAGS) -Itests/reference -Iplatform/host -std=c++17 -Wall \
		-Wextra -Wshadow -Werror -O3 $(BENCH_FLAGS) -MMD -MP -c -o $@ $<

$(BUILD)/bench/%.c.o: bench/%.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) -Iplatform/host $(HOST_FLAGS) $(CFLAGS) -MMD -MP \
		-c -o $@ $<
