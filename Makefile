# Texel by Texel: every command. `make help` lists them.

B := build
LESSONS := $(patsubst lessons/%/lesson.c,%,$(wildcard lessons/[0-9][0-9]-*/lesson.c))
NUMBERS := $(foreach lesson,$(LESSONS),$(firstword $(subst -, ,$(lesson))))
lesson_of = $(filter $(1)-%,$(LESSONS))

ifneq ($(V),1)
Q := @
say = @printf '  %-8s %s\n' $(1) $(2)
endif

# The project's own flags; CFLAGS, CXXFLAGS and LDFLAGS are the user's and come after them.
# (errno and interposition: so that sqrt is one instruction, and a call within the library is a call.)
TEXEL_FLAGS := -fno-math-errno -fno-semantic-interposition -Wall -Wextra -Wpedantic -O2 -g -fPIC -MMD -MP -Icommon
TEXEL_CFLAGS := -std=c17 $(TEXEL_FLAGS)
TEXEL_CXXFLAGS := -std=c++20 $(TEXEL_FLAGS)
TEXEL_LIBS = $(shell pkg-config --libs glfw3 osmesa) -lm -pthread -ldl
LINK_TEXEL = -L$(B) -ltexel -Wl,-rpath,'$$ORIGIN' -lm
LINK_RAYS = -Wl,--as-needed -ltexel-rays $(EMBREE_LIBS)
EMBREE_LIBS := -lembree3

.DEFAULT_GOAL := all
.DELETE_ON_ERROR:
.SECONDARY:

all: $(LIBRARIES) $(LESSONS:%=$(B)/%) $(TOOLS) $(B)/light-field assets ## build everything

help: ## list these commands
	@grep -hE '^[^#[:space:]].*:.*## ' $(MAKEFILE_LIST) | sed -E 's/^.*: ([a-z-]*)%:/\1NN:/; s/:.*## /\t/' \
		| awk -F'\t' '{printf "make %-14s %s\n", $$1, $$2}'

# ---- The library ----

COMMON_OBJECTS := $(patsubst common/%,$(B)/obj/common/%.o,$(wildcard common/*.c))
RAYS_OBJECTS := $(B)/obj/common/mesh_rays.c.o
LIBRARIES := $(B)/libtexel.so $(B)/libtexel-files.so $(B)/libtexel-rays.so

$(B)/obj/%.c.o: %.c
	$(call say,CC,$<)
	$(Q)mkdir -p $(@D)
	$(Q)$(CC) $(TEXEL_CFLAGS) $(CFLAGS) -c $< -o $@

$(B)/obj/%.cpp.o: %.cpp
	$(call say,CXX,$<)
	$(Q)mkdir -p $(@D)
	$(Q)$(CXX) $(TEXEL_CXXFLAGS) $(CXXFLAGS) -c $< -o $@

# A shared library, so that linking a lesson takes no time; image files are in one of their own, loaded when the
# first is read (common/image_files.h says why). Embree costs a start 1 ms of 25, so only who asks for rays against
# meshes is linked with it. And an archive for tests, which take from it only what they use.
$(B)/libtexel.so: $(filter-out $(RAYS_OBJECTS),$(COMMON_OBJECTS))
	$(call say,LINK,$@)
	$(Q)$(CC) -shared $(CFLAGS) $(LDFLAGS) $^ $(TEXEL_LIBS) -Wl,-rpath,'$$ORIGIN' -o $@

$(B)/libtexel-files.so: $(B)/obj/common/image.cpp.o | $(B)/libtexel.so
	$(call say,LINK,$@)
	$(Q)$(CXX) -shared $(CXXFLAGS) $(LDFLAGS) $< $(shell pkg-config --libs OpenImageIO) $(LINK_TEXEL) -o $@

$(B)/libtexel-rays.so: $(RAYS_OBJECTS) | $(B)/libtexel.so
	$(call say,LINK,$@)
	$(Q)$(CC) -shared $(CFLAGS) $(LDFLAGS) $^ $(EMBREE_LIBS) $(LINK_TEXEL) -o $@

$(B)/libtexel.a: $(COMMON_OBJECTS)
	$(call say,AR,$@)
	$(Q)rm -f $@ && $(AR) rcs $@ $^

# ---- Lessons: one folder, one program; test_*.c beside them are tests, and tool_NAME.c programs of their own ----

lesson_sources = $(filter-out $(wildcard lessons/$(1)/test_*.c lessons/$(1)/tool_*.c),$(wildcard lessons/$(1)/*.c))
lesson_tools = $(patsubst lessons/$(1)/tool_%.c,$(B)/$(firstword $(subst -, ,$(1)))-%,$(wildcard lessons/$(1)/tool_*.c))
TOOLS := $(foreach lesson,$(LESSONS),$(call lesson_tools,$(lesson)))

define LESSON_RULES
$(B)/$(1): $(patsubst %,$(B)/obj/%.o,$(call lesson_sources,$(1))) | $(LIBRARIES)
	$$(call say,LINK,$$@)
	$$(Q)$$(CC) $$(CFLAGS) $$(LDFLAGS) $$^ $$(LINK_RAYS) $$(LINK_TEXEL) -o $$@
endef
$(foreach lesson,$(LESSONS),$(eval $(call LESSON_RULES,$(lesson))))

$(NUMBERS): %: all ## (a lesson's number) open the lesson in a window
	$(Q)$(B)/$(call lesson_of,$*)

# build/NN-NAME takes from the lesson's other sources, as from the library, only what it needs.
define TOOL_RULES
$(B)/obj/lessons/$(1).a: $(patsubst %,$(B)/obj/%.o,$(filter-out %/lesson.c,$(call lesson_sources,$(1))))
	$$(Q)rm -f $$@ && $$(AR) rcs $$@ $$^
$(call lesson_tools,$(1)): $(B)/$(firstword $(subst -, ,$(1)))-%: $(B)/obj/lessons/$(1)/tool_%.c.o \
	$(B)/obj/lessons/$(1).a $(B)/libtexel.a
	$$(call say,LINK,$$@)
	$$(Q)$$(CC) $$(CFLAGS) $$(LDFLAGS) -Wl,--as-needed $$^ $$(TEXEL_LIBS) -o $$@
$(B)/$(1): | $(call lesson_tools,$(1))
endef
$(foreach lesson,$(LESSONS),$(if $(call lesson_tools,$(lesson)),$(eval $(call TOOL_RULES,$(lesson)))))

-include assets/assets.mk
-include tests/cases.mk
-include tests/tests.mk
-include common/report.mk

assets: $(ASSETS)

# ---- What a machine needs ----

install: ## install the Debian packages of packages.txt that are missing
	$(Q)sh tests/packages.sh install

doctor: ## say what is missing on this machine
	$(Q)sh tests/packages.sh doctor

clean: ## remove what was made
	rm -rf $(B)

.PHONY: all help assets install doctor clean $(NUMBERS)

-include $(shell find $(B) -name '*.d' 2>/dev/null)
