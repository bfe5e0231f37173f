# The laboratory: speed against accuracy, the papers' experiments, and where
# methods fail. Included by the Makefile for CONF=host.
.PHONY: lab lab-quick lab-unit lab-programs lab-deps

LAB_PACKAGES = $(PACKAGES) gnuplot-nox librsvg2-bin gcc-arm-none-eabi \
	qemu-system-arm
LAB_OBJ = $(patsubst lab/%.c,$(BUILD)/lab/obj/%.o,$(wildcard lab/*.c))
LAB_PROGRAMS = $(BUILD)/brume-lab $(BUILD)/brume-reference \
	$(BUILD)/brume-monte-carlo $(BUILD)/brume-spec-dump \
	$(BUILD)/brume-papers $(BUILD)/brume-atlas
LAB_TIMED = $(BUILD)/brume-bench # of the full laboratory: NanoVDB
LAB_RUN = BUILD=$(BUILD) DATA=$(DATA) JOBS=$(JOBS) sh lab/run.sh

lab: lab-deps ## every experiment, into docs/lab; goes on where it was stopped
	@$(MAKE) --no-print-directory -j$(JOBS) all $(LAB_PROGRAMS) \
		$(LAB_TIMED)
	@$(LAB_RUN) all

lab-quick: lab-deps ## the same, small and without a page: checks the claims
	@$(MAKE) --no-print-directory -j$(JOBS) all $(LAB_PROGRAMS)
	@QUICK=1 $(LAB_RUN) all

lab-unit: lab-programs ## one unit of it: UNIT=name (lab/run.sh list)
	@$(LAB_RUN) unit $(UNIT)

lab-programs: # what units need, without packages
	@$(MAKE) --no-print-directory -s -j$(JOBS) all $(LAB_PROGRAMS)

lab-deps: ## packages for the laboratory: charts
	@sh platform/host/deps.sh $(LAB_PACKAGES)

$(BUILD)/brume-lab: $(LAB_OBJ) $(filter-out %/main.o,$(HOST_OBJ)) \
		$(BUILD)/tables/noise/fft.o $(BUILD)/libbrume.a
	$(CC) $(LDFLAGS) -o $@ $^ -lm -lpthread

$(BUILD)/lab/obj/%.o: lab/%.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) -Iplatform/host -Itables/noise $(HOST_FLAGS) \
		$(CFLAGS) -MMD -MP -c -o $@ $<

$(BUILD)/brume-papers: $(BUILD)/lab/papers/papers_main.o $(REFERENCE_OBJ)
	$(CXX) $(LDFLAGS) -o $@ $^ -lpthread

$(BUILD)/lab/papers/%.o: lab/papers/%.cpp
	@mkdir -p $(@D)
	$(CXX) $(CPPFLAGS) -Itests/reference -std=c++17 $(WARN) $(CXXFLAGS) \
		-MMD -MP -c -o $@ $<
