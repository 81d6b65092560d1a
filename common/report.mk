# The report: what each lesson shows, costs and errs. Lessons are measured one after another and with nothing
# beside them, for what runs beside a timing is in it. Included by the Makefile.
#
# One run of a lesson's program writes its pictures, its truths, its heat maps and its table; a second program
# its hard cases; report.pl makes pages of them. Smaller and quicker: make report-14 REPORT_FLAGS='--size 320x240'

REPORT := $(B)/report
CASES_LESSONS := $(patsubst lessons/%/cases.h,%,$(wildcard lessons/*/cases.h))

# make starts afresh after install, for what pkg-config says is read while a makefile is.
report: ## install what is missing, build, render and measure every lesson: build/report/index.html
	$(Q)$(MAKE) --no-print-directory install
	$(Q)$(MAKE) --no-print-directory $(if $(findstring -j,$(MAKEFLAGS)),,-j$(shell nproc)) report-programs
	$(call measure,$(LESSONS))
	$(Q)perl common/report.pl $(REPORT) $(LESSONS)

$(NUMBERS:%=report-%): report-%: ## one lesson's page: build/report/NN-name.html
	$(Q)$(MAKE) $(if $(Q),-s) --no-print-directory $(B)/$(call lesson_of,$*) assets \
		$(patsubst %,$(B)/tests/cases-%,$(filter $(call lesson_of,$*),$(CASES_LESSONS)))
	$(call measure,$(call lesson_of,$*))
	$(Q)perl common/report.pl $(REPORT) $(call lesson_of,$*) -- $(LESSONS)

report-programs: all $(CASES_LESSONS:%=$(B)/tests/cases-%)

# What an earlier run left would speak for this one, so it goes first. A hard case that fails is a row of the
# report, and no reason to stop; that the program writes no rows is one. The pages show the PNGs; the same in
# floats, 4 MB each, is for who asks with --render.
measure = @done=0; start=$$(date +%s); for lesson in $(1); do \
	spent=$$(($$(date +%s) - start)); \
	printf 'lesson %d of %d: %s' $$((done + 1)) $(words $(1)) $$lesson; \
	[ $$done = 0 ] || printf ', about %d s left' $$((spent * ($(words $(1)) - done) / done)); \
	echo; \
	at=$(REPORT)/$$lesson; \
	rm -rf $$at $$at.html $$at.csv $$at.list $$at-curves.csv $$at-cases.csv; \
	mkdir -p $$at; \
	$(B)/$$lesson --list $(REPORT_FLAGS) >$$at.list || exit 1; \
	$(B)/$$lesson --render $$at --truth $$at --errors $$at --measure $$at.csv --brief $(REPORT_FLAGS) || exit 1; \
	rm -f $$at/*.exr; \
	if [ -e lessons/$$lesson/cases.h ]; then \
		$(B)/tests/cases-$$lesson $$at-cases.csv >$$at/cases.log \
			|| echo "$$lesson: hard cases fail; see $$at/cases.log"; \
		[ -s $$at-cases.csv ] || { echo "$$at-cases.csv: was not written" >&2; exit 1; }; \
	fi; \
	done=$$((done + 1)); \
	echo "$$lesson: $$(($$(date +%s) - start - spent)) s"; \
done

.PHONY: report report-programs $(NUMBERS:%=report-%)
