# What makes build/assets: included by the Makefile. ASSETS is every image that a lesson may ask for.

GENERATED := $(addprefix $(B)/assets/,checker.png zone-plate.png uv-grid.png soft-height.png pins-height.png \
	brick-colour.png brick-height.png brick-normal.png \
	brick-256-colour.png brick-256-height.png brick-256-normal.png)
fetched_rows := NR > 1 && $$NF !~ /^later/ { print $$1 }
FETCHED := $(addprefix $(B)/assets/,$(shell awk -F, '$(fetched_rows)' assets/manifest.csv))
STEREO := $(addprefix $(B)/assets/,stereo-colour.png stereo-height.exr stereo-mask.png stereo-relief.exr)
OBJECTS := $(foreach face,left right bottom top back front,$(B)/assets/solids-$(face).png $(B)/assets/bunny-$(face).png)
ASSETS := $(GENERATED) $(FETCHED) $(STEREO) $(OBJECTS) $(addprefix $(B)/assets/,terrain-relief.png brick-relief.png)

# The library is only needed to be there: when it changes, the pictures stay what they are. Without
# contraction a*b + c is rounded twice on every machine, so every machine draws the same bytes.
$(B)/generate $(B)/stereo $(B)/terrain $(B)/relief $(B)/object: $(B)/%: assets/%.c | $(LIBRARIES)
	$(call say,CC,$<)
	$(Q)$(CC) $(TEXEL_CFLAGS) $(CFLAGS) -ffp-contract=off -MMD -MP -MT $@ -MF $@.d -o $@ $< \
		$(LDFLAGS) $(LINK_RAYS) $(LINK_TEXEL)

# Of the library only what it needs, which is no OpenGL: so it starts at once, and takes little memory.
$(B)/light-field: $(B)/obj/assets/light_field.c.o $(B)/libtexel.a
	$(call say,LINK,$@)
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) $^ -lm -pthread -ldl -o $@

# fetch leaves alone what is there, so its files may be older than the manifest: touch says they are checked.
$(FETCHED) &: assets/fetch assets/manifest.csv
	$(call say,FETCH,assets/manifest.csv)
	$(Q)assets/fetch $(B)/assets
	$(Q)touch $(FETCHED)

$(GENERATED) &: $(B)/generate
	$(call say,DRAW,$(B)/assets)
	$(Q)mkdir -p $(B)/assets
	$(Q)$(B)/generate $(B)/assets >$(B)/generate.log

$(STEREO) &: $(B)/stereo $(B)/assets/motorcycle_left.png $(B)/assets/motorcycle_disp.npy
	$(call say,STEREO,$(B)/assets)
	$(Q)$(B)/stereo $(B)/assets >$(B)/stereo.log

$(B)/assets/terrain-relief.png: $(B)/terrain $(B)/assets/topography.png
	$(call say,TERRAIN,$@)
	$(Q)$(B)/terrain $(B)/assets >$(B)/terrain.log

# Of the library, what these pictures show is in four of its files.
$(OBJECTS) &: $(B)/object $(B)/assets/bunny.obj $(addprefix common/,object.c solid.c mesh_file.c mesh_rays.c)
	$(call say,OBJECT,$(B)/assets)
	$(Q)$(B)/object $(B)/assets >$(B)/object.log

# A brick and its joint are 240 mm by 90 mm.
$(B)/assets/brick-relief.png: $(B)/relief $(B)/assets/brick-256-colour.png $(B)/assets/brick-256-height.png
	$(call say,RELIEF,$@)
	$(Q)$(B)/relief combine $(filter %.png,$^) $@ --width 720 --unit mm

# COLOUR, HEIGHT and OUT are files; SCALE, BASE, WIDTH and UNIT may be left out (build/relief --help).
relief: $(B)/relief ## (COLOUR=a.png HEIGHT=b.png OUT=c.png) make a relief texture of two images
	$(if $(and $(COLOUR),$(HEIGHT),$(OUT)),,$(error usage: make relief COLOUR=a.png HEIGHT=b.png OUT=c.png \
		[SCALE=0.1 BASE=1 WIDTH=2.5 UNIT=m]))
	$(Q)$(B)/relief combine $(if $(SCALE),--scale '$(SCALE)') $(if $(BASE),--base '$(BASE)') \
		$(if $(WIDTH),--width '$(WIDTH)') $(if $(UNIT),--unit '$(UNIT)') -- '$(COLOUR)' '$(HEIGHT)' '$(OUT)'

# Hundreds of megabytes, so no part of `make all`. What was stopped goes on, and what is there stays.
FIELD_KIND = $(addprefix -,$(filter-out linear,$(ANGLES)))$(addprefix -,$(MODEL))
FIELD_OUT = $(or $(OUT),$(B)/fields/$(or $(SCENE),composed)-$(SIZE)-$(or $(SAMPLES),7)$(FIELD_KIND).field)
light-field: $(B)/light-field ## (SIZE=512x256x32x32 SCENE=composed) make a light field as a file, in build/fields
	$(if $(SIZE),,$(error usage: make light-field SIZE=512x256x32x32 \
		[SCENE=composed SAMPLES=7 ANGLES=linear MODEL=sphere OUT=a.field]))
	$(Q)mkdir -p $(B)/fields
	$(Q)$(B)/light-field make '$(FIELD_OUT)' --size '$(SIZE)' $(if $(SCENE),--scene '$(SCENE)') \
		$(if $(SAMPLES),--samples '$(SAMPLES)') $(if $(ANGLES),--angles '$(ANGLES)') $(if $(MODEL),--model '$(MODEL)')

# The same, encoded, and never whole in memory; TECHNIQUE is bc1, bc7, vq or ramp. lessons/19-light-field-compression.
ENCODED_OUT = $(or $(OUT),$(B)/fields/$(or $(SCENE),composed)-$(SIZE)-$(or $(SAMPLES),7)-$(or $(TECHNIQUE),ramp)$(addprefix -,$(KNOB)).field)
light-field-encode: $(B)/19-encode ## (SIZE=1024x512x128x128 TECHNIQUE=ramp KNOB=8) encode a light field as a file
	$(if $(SIZE)$(FROM),,$(error usage: make light-field-encode SIZE=512x256x32x32 \
		[SCENE=composed SAMPLES=7 TECHNIQUE=ramp KNOB=8 OUT=a.field BANDS=4 VERIFY=1], or FROM=raw.field OUT=a.field))
	$(Q)mkdir -p $(B)/fields
	$(Q)$(B)/19-encode make '$(ENCODED_OUT)' $(if $(SIZE),--size '$(SIZE)') $(if $(FROM),--from '$(FROM)') \
		$(if $(SCENE),--scene '$(SCENE)') $(if $(SAMPLES),--samples '$(SAMPLES)') $(if $(VERIFY),--verify) \
		$(if $(TECHNIQUE),--technique '$(TECHNIQUE)') $(if $(KNOB),--knob '$(KNOB)') $(if $(BANDS),--bands '$(BANDS)')

.PHONY: relief light-field light-field-encode

# A .npz is a zip archive; unzip checks what it unpacks.
$(B)/assets/motorcycle_disp.npy: $(B)/assets/motorcycle_disp.npz
	$(Q)unzip -p $< arr_0.npy >$@.part && mv $@.part $@

-include $(B)/generate.d $(B)/stereo.d $(B)/terrain.d $(B)/relief.d $(B)/object.d
