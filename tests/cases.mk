# The hard cases of each lesson that has a cases.h: build/tests/cases-NN-name. A program is cases.c, which knows
# no lesson, and the lesson's table, compiled in two precisions. And the test of all shaders.

# g++ alone has -fsingle-precision-constant, and GLSL's T(a, b) for structures before clang 16.
CASES_CXX := g++
CASES_CXXFLAGS := -std=c++20 -Wall -Wextra -Wno-deprecated -Winvalid-pch -O0 -ffp-contract=off \
	-DGLM_FORCE_SWIZZLE -D_MSC_EXTENSIONS -fms-extensions -Icommon -Itests -MMD -MP
CASES_FLAGS_float := -fsingle-precision-constant
CASES_FLAGS_double := -DCASES_DOUBLE

CASES := $(B)/tests
CASES_TESTS := $(patsubst lessons/%/cases.h,$(CASES)/cases-%,$(wildcard lessons/*/cases.h))

.PHONY: FORCE

# GLM precompiled in each precision; -include finds it by the folder's name.
$(CASES)/float/glsl.hpp.gch $(CASES)/double/glsl.hpp.gch: $(CASES)/%/glsl.hpp.gch: tests/glsl.hpp
	$(call say,CXX,"$< ($*)")
	$(Q)mkdir -p $(@D)
	$(Q)$(CASES_CXX) $(CASES_CXXFLAGS) $(CASES_FLAGS_$*) $(CXXFLAGS) -x c++-header $< -o $@

# A lesson's folder, or that of the cases which test the harness itself (harness.t).
cases_folder = $(wildcard lessons/$1 tests/fixtures/$1)

# What a table includes: each technique file once, even where one includes another, and common's first.
# Replaced only when the list changes, for the table would be compiled again.
$(CASES)/%/techniques.h: FORCE
	@mkdir -p $(@D)
	@printf '#import "%s"\n' $(notdir $(wildcard common/*.glsl) \
		$(wildcard $(call cases_folder,$*)/*.glsl)) >$@.new
	@if cmp -s $@.new $@; then rm $@.new; else mv $@.new $@; fi

cases_libraries = -Wl,--as-needed $(B)/libtexel.a $(TEXEL_LIBS)

cases_compile = $(CASES_CXX) $(CASES_CXXFLAGS) $(CASES_FLAGS_$(basename $(@F))) $(CXXFLAGS) \
	-include $(CASES)/$(basename $(@F))/glsl.hpp -I$(CASES)/$* -I$(call cases_folder,$*) \
	-DCASES_FOLDER='"$(call cases_folder,$*)"' -c $< -o $@

$(CASES)/%/float.o: tests/cases_glm.cpp $(CASES)/%/techniques.h $(CASES)/float/glsl.hpp.gch
	$(call say,CXX,"$(call cases_folder,$*)/cases.h ($(basename $(@F)))")
	$(Q)$(cases_compile)

$(CASES)/%/double.o: tests/cases_glm.cpp $(CASES)/%/techniques.h $(CASES)/double/glsl.hpp.gch
	$(call say,CXX,"$(call cases_folder,$*)/cases.h ($(basename $(@F)))")
	$(Q)$(cases_compile)

# Linked by g++, whose library GLM's templates may need.
$(CASES)/cases-%: $(B)/obj/tests/cases.c.o $(CASES)/%/float.o $(CASES)/%/double.o $(B)/libtexel.a
	$(call say,LINK,$@)
	$(Q)$(CASES_CXX) $(CXXFLAGS) $(LDFLAGS) $(filter %.o,$^) $(cases_libraries) -o $@

$(CASES)/shaders: $(B)/obj/tests/shaders.c.o $(B)/libtexel.a
	$(call say,LINK,$@)
	$(Q)mkdir -p $(@D)
	$(Q)$(CXX) $(CXXFLAGS) $(LDFLAGS) $< $(cases_libraries) -o $@

test-build: $(CASES)/cases-harness
