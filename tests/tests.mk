# Tests: units and hard cases first, several at once; then what measures time, last and alone.

TESTS := $(B)/tests

# Units: tests/test_*.c, and a lesson's own beside its sources, which are linked in.
UNIT_TESTS := $(patsubst tests/%.c,$(TESTS)/%,$(wildcard tests/test_*.c))
LESSON_TESTS := $(patsubst lessons/%.c,$(TESTS)/%,$(wildcard lessons/*/test_*.c))
tests_of = $(filter $(TESTS)/$(1)/%,$(LESSON_TESTS)) $(filter $(TESTS)/cases-$(1),$(CASES_TESTS))

link_test = $(CC) $(CFLAGS) $(LDFLAGS) -Wl,--as-needed $(filter %.o,$^) $(B)/libtexel.a -lcmocka $(TEXEL_LIBS) $(EMBREE_LIBS) \
	-Wl,-rpath,'$(CURDIR)/$(B)' -o $@

$(UNIT_TESTS) $(TESTS)/png_difference: $(TESTS)/%: $(B)/obj/tests/%.c.o $(B)/libtexel.a | $(LIBRARIES)
	$(call say,LINK,$@)
	$(Q)mkdir -p $(@D)
	$(Q)$(link_test)

define LESSON_TEST_RULES
$(filter $(TESTS)/$(1)/%,$(LESSON_TESTS)): $(TESTS)/%: $(B)/obj/lessons/%.c.o \
	$(patsubst %,$(B)/obj/%.o,$(filter-out %/lesson.c,$(call lesson_sources,$(1)))) $(B)/libtexel.a | $(LIBRARIES)
	$$(call say,LINK,$$@)
	$$(Q)mkdir -p $$(@D)
	$$(Q)$$(link_test)
endef
$(foreach lesson,$(LESSONS),$(if $(filter $(TESTS)/$(lesson)/%,$(LESSON_TESTS)),$(eval $(call LESSON_TEST_RULES,$(lesson)))))

# The errors of each lesson's pictures: a program a lesson, so that they run side by side.
PICTURES := $(LESSONS:%=$(TESTS)/pictures-%)
$(PICTURES): $(TESTS)/pictures-%: tests/pictures.t
	$(Q)mkdir -p $(@D)
	$(Q)printf '#!/bin/sh\nexec tests/pictures.t --errors $*\n' >$@ && chmod +x $@

# The longest first, so that none is left to run alone at the end.
PARALLEL_TESTS = $(PICTURES) $(filter-out tests/pictures.t,$(wildcard tests/*.t)) \
	$(LESSON_TESTS) $(CASES_TESTS) $(UNIT_TESTS) $(TESTS)/shaders
TEST_PROGRAMS = $(PICTURES) $(UNIT_TESTS) $(LESSON_TESTS) $(CASES_TESTS) $(TESTS)/shaders $(TESTS)/png_difference

# Without --exec '' prove would hand programs to perl.
PROVE := prove --exec '' -j2
PROVE_COSTS := prove --exec '' tests/pictures.t :: --costs

test: install ## install what is missing, build, and run every test
	$(Q)$(MAKE) --no-print-directory -j$(shell nproc) test-build
	$(Q)$(PROVE) $(PARALLEL_TESTS)
	$(Q)$(PROVE_COSTS)

test-build: all $(TEST_PROGRAMS)

$(foreach lesson,$(LESSONS),$(eval test-$(firstword $(subst -, ,$(lesson))): \
	$(TESTS)/pictures-$(lesson) $(call tests_of,$(lesson)) $(TESTS)/shaders $(TESTS)/png_difference))
$(NUMBERS:%=test-%): test-%: all ## (test-14) a lesson's tests alone
	$(Q)$(PROVE) $(TESTS)/pictures-$(call lesson_of,$*) $(call tests_of,$(call lesson_of,$*)) $(TESTS)/shaders
	$(Q)$(PROVE_COSTS) $(call lesson_of,$*)

# The units and the hard cases once more, built into a folder of their own with the sanitizers in (whose dlopen
# looks for libtexel-files.so in LD_LIBRARY_PATH alone).
SANITIZE := -fsanitize=address,undefined -fno-omit-frame-pointer
sanitize: ## unit and hard-case tests under ASan and UBSan
	$(Q)$(MAKE) --no-print-directory B=$(B)/sanitize CFLAGS="$(CFLAGS) $(SANITIZE)" CXXFLAGS="$(CXXFLAGS) $(SANITIZE)" \
		LDFLAGS="$(LDFLAGS) $(SANITIZE)" -j$(shell nproc) sanitize-run

sanitize-run: $(filter-out $(PICTURES) $(TESTS)/png_difference,$(TEST_PROGRAMS))
	$(Q)LD_LIBRARY_PATH=$(B) LSAN_OPTIONS=suppressions=$(CURDIR)/tests/lsan.supp:print_suppressions=0 UBSAN_OPTIONS=halt_on_error=1 \
		$(PROVE) $(UNIT_TESTS) $(LESSON_TESTS) $(CASES_TESTS)

SOURCES = $(shell git ls-files '*.c' '*.h' '*.cpp' '*.hpp' | grep -v 'cases\.h$$')
format-check: ## demand clang-format's layout (its package: packages-dev.txt)
	$(Q)clang-format --dry-run --Werror $(SOURCES)

.PHONY: test test-build $(NUMBERS:%=test-%) sanitize sanitize-run format-check
