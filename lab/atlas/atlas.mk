# brume-atlas, for the stability atlas: `sh lab/atlas/run.sh`
ATLAS_OBJ = $(patsubst lab/%.c,$(BUILD)/lab/%.o,$(wildcard lab/atlas/*.c))

$(BUILD)/brume-atlas: $(ATLAS_OBJ) $(TEST_LIB_OBJ) $(BUILD)/libbrume.a
	$(CC) $(LDFLAGS) -o $@ $^ -lm -lpthread

$(BUILD)/lab/atlas/%.o: lab/atlas/%.c
	@mkdir -p $(@D)
	$(CC) $(CPPFLAGS) -Itests -Iplatform/host $(HOST_FLAGS) $(CFLAGS) \
		-MMD -MP -c -o $@ $<
