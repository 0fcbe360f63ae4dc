# libsph. `make help` lists the targets.
#
# Variables: CC CFLAGS LDFLAGS PREFIX DESTDIR V=1 WERROR=1
#   BUILD=build-x    another build folder; libraries then go to build-x/lib instead of lib
#   FOLDERS="core kernel"   only these folders of src (needs its own BUILD)
#   SKIP="rkc"              not these
#   TESTS="core kernel"     only tests/*/test_core.c and tests/*/test_kernel.c
#   CASE=name               only this validation case
#   CMOCKA=0                the built-in harness even where cmocka is installed
#   JOBS=2                  test programs run at the same time
#   BENCH_ARGS="only=wcsph_rhs dim=3 n=100000"   arguments of the benchmarks (tests/bench/bench_args.h)

CC ?= cc
CXX ?= c++
AR ?= ar
CFLAGS ?= -O2 -g
PREFIX ?= /usr/local
libdir ?= $(PREFIX)/lib
includedir ?= $(PREFIX)/include
BUILD ?= build
JOBS ?= 2
V ?= 0
WERROR ?= 0
# Programs of examples/ understand the argument `validate`, but for those that only show something.
EXAMPLE_CASES ?= $(filter-out first_steps,$(basename $(notdir $(wildcard examples/*.c))))

# The C++ compiler beside the C one (gcc-12: g++-12), else any.
ifeq ($(origin CXX),default)
CXX := $(shell command -v $(subst gcc,g++,$(subst clang,clang++,$(firstword $(CC)))) | \
  grep '++' || command -v g++ || command -v clang++ || echo g++)
endif
HAVE_CXX := $(shell command -v $(firstword $(CXX)))

Q := $(if $(filter 1,$(V)),,@)
# Usage: $(call need,tool,Debian package)
need = @command -v $(1) > /dev/null 2>&1 || \
  { echo '$(1) is missing: install the Debian package $(2)'; exit 1; }
say = $(if $(filter 1,$(V)),,@printf '  %-6s %s\n' '$(1)' '$(2)')

# --- version: base.h is the only place where it stands
version_of = $(shell awk '$$2 == "SPH_VERSION_$(1)" { print $$3 }' include/sph/base.h)
MAJOR := $(call version_of,MAJOR)
VERSION := $(MAJOR).$(call version_of,MINOR).$(call version_of,PATCH)

# --- outputs
ifeq ($(BUILD),build)
ifdef FOLDERS
$(error FOLDERS builds a part of the library: give it its own BUILD=build-name)
endif
OUT := lib
else
OUT := $(BUILD)/lib
endif
SONAME := libsph.so.$(MAJOR)
SO := $(OUT)/libsph.so.$(VERSION)
SO_LINKS := $(OUT)/$(SONAME) $(OUT)/libsph.so
LIB_A := $(OUT)/libsph.a

# --- flags
WARN := -Wall -Wextra -Wpedantic -Wconversion -Wshadow
STRICT := $(WARN) $(if $(filter 1,$(WERROR)),-Werror)
# The order and rounding of every sum is part of the result: no contraction into FMA.
SEMANTICS := -std=c11 -ffp-contract=off -fno-math-errno -D_XOPEN_SOURCE=700
BASE := $(CFLAGS) $(SEMANTICS) -pthread -Iinclude $(CPPFLAGS)
LIBS := -lm -pthread
# A sanitizer of clang lives in the program, so its builds leave symbols open.
DEFS := -Wl,-z,defs

MACHINE := $(shell $(CC) -dumpmachine)
ifneq ($(filter x86_64% amd64%,$(MACHINE)),)
AVX2 := -mavx2 -mfma
AVX512 := -mavx512f -mavx512dq -mavx512vl -mavx512bw $(AVX2)
endif
isa_flags = $(if $(findstring _avx512,$(notdir $(1))),$(AVX512),$(if $(findstring _avx2,$(notdir $(1))),$(AVX2)))

ifndef CMOCKA
CMOCKA := $(shell $(CC) -include stdarg.h -include stddef.h -include stdint.h -include setjmp.h \
  -include cmocka.h -x c -o /dev/null tests/tools/empty.c -lcmocka 2>/dev/null && echo 1 || echo 0)
endif
ifeq ($(CMOCKA),1)
TEST_CPP := -DSPH_HAVE_CMOCKA
TEST_LIBS := -lcmocka
endif

# --- sources
ifdef FOLDERS
SRC := $(sort $(foreach f,$(FOLDERS),$(wildcard src/$(f)/*.c)))
else
SRC := $(sort $(wildcard src/*/*.c))
endif
# The committed list rules; without it, or for a part of the library, what exists is exported.
MAP := $(if $(FOLDERS),$(BUILD)/libsph.map,$(or $(wildcard lib/libsph.map),$(BUILD)/libsph.map))
OBJ := $(SRC:%.c=$(BUILD)/%.o)

named = $(foreach t,$(1),%/test_$(t).c %/test_$(t).cpp)
pick = $(filter-out $(call named,$(SKIP)),$(if $(TESTS),$(filter $(call named,$(TESTS)),$(1)),$(1)))
UNIT := $(call pick,$(sort $(wildcard tests/unit/test_*.c)))
API := $(call pick,$(sort $(wildcard tests/api/test_*.c)))
API_CXX := $(call pick,$(sort $(wildcard tests/api/test_*.cpp)))
UNIT_BIN := $(UNIT:%.c=$(BUILD)/%)
API_BIN := $(API:%.c=$(BUILD)/%) $(if $(HAVE_CXX),$(API_CXX:%.cpp=$(BUILD)/%))
BENCH_BIN := $(patsubst %.c,$(BUILD)/%,$(sort $(wildcard tests/bench/*.c)))
EXAMPLE_BIN := $(patsubst %.c,$(BUILD)/%,$(sort $(wildcard examples/*.c)))
CASE_BIN := $(patsubst %.c,$(BUILD)/%,$(sort $(wildcard tests/validation/*.c) \
  $(wildcard $(EXAMPLE_CASES:%=examples/%.c))))
ifdef CASE
CASE_BIN := $(filter %/$(CASE),$(CASE_BIN))
endif
ALL_BIN := $(UNIT_BIN) $(API_BIN) $(BENCH_BIN) $(EXAMPLE_BIN) $(CASE_BIN)
HEADERS := $(sort $(wildcard include/sph/*.h))

.PHONY: all lib examples tests demo check check-long validate validate-long bench \
  bench-instructions symbols \
  check-headers check-symbols check-layers check-readme check-abi record-abi check-asan check-tsan \
  check-aarch64 check-valgrind check-install format check-format install uninstall clean help FORCE
.DELETE_ON_ERROR:
.SECONDARY:

all: lib examples
lib: $(SO) $(SO_LINKS) $(LIB_A)
examples: $(EXAMPLE_BIN)
tests: $(UNIT_BIN) $(API_BIN)

# --- objects and libraries
# Objects are rebuilt when compiler or flags change; -Werror changes no object.
$(BUILD)/flags: FORCE
	$(call need,$(firstword $(CC)),$(notdir $(firstword $(CC))))
	@mkdir -p $(@D)
	@printf '%s\n' '$(CC) $(BASE) $(TEST_CPP)' | cmp -s - $@ || \
	  printf '%s\n' '$(CC) $(BASE) $(TEST_CPP)' > $@

$(BUILD)/src/%.o: src/%.c $(BUILD)/flags
	@mkdir -p $(@D)
	$(call say,CC,$<)
	$(Q)$(CC) $(BASE) $(STRICT) -fPIC -fvisibility=hidden $(call isa_flags,$<) -MMD -MP -c $< -o $@

# A source that comes or goes changes the libraries too.
$(BUILD)/sources: FORCE
	@mkdir -p $(@D)
	@printf '%s\n' '$(SRC)' | cmp -s - $@ || printf '%s\n' '$(SRC)' > $@

# The archive is made anew, or objects of deleted sources would stay in it.
$(LIB_A): $(OBJ) $(BUILD)/sources
	@mkdir -p $(@D)
	$(call say,AR,$@)
	$(Q)rm -f $@ && $(AR) rcs $@ $(OBJ)

$(BUILD)/libsph.map: $(LIB_A) $(HEADERS) tests/tools/make_map.sh
	$(Q)CC='$(CC)' tests/tools/make_map.sh $(LIB_A) $@ /dev/null

$(SO): $(OBJ) $(MAP) $(BUILD)/sources
	@mkdir -p $(@D)
	$(call say,LD,$@)
	$(Q)$(CC) $(CFLAGS) -shared -fPIC -Wl,-soname,$(SONAME) -Wl,--version-script=$(MAP) $(DEFS) \
	  -Wl,--no-undefined-version $(LDFLAGS) -o $@ $(OBJ) $(LIBS)

$(SO_LINKS): $(SO)
	$(Q)ln -sf $(notdir $(SO)) $@

# --- programs
HOST = $(BASE) $(STRICT) -MMD -MP -MT $@ -MF $@.d
HOST_CXX = $(CFLAGS) -std=c++11 -pthread -Iinclude $(CPPFLAGS) $(STRICT) -MMD -MP -MT $@ -MF $@.d
LINK_SO = -L$(OUT) -Wl,-rpath,$(abspath $(OUT)) -lsph $(LIBS)

$(BUILD)/tests/unit/%: tests/unit/%.c $(LIB_A) $(BUILD)/flags
	@mkdir -p $(@D)
	$(call say,TEST,$<)
	$(Q)$(CC) $(HOST) $(TEST_CPP) -Isrc -Itests $(LDFLAGS) $< -o $@ $(LIB_A) $(TEST_LIBS) $(LIBS)

$(BUILD)/tests/api/%: tests/api/%.c $(SO) $(SO_LINKS) $(BUILD)/flags
	@mkdir -p $(@D)
	$(call say,TEST,$<)
	$(Q)$(CC) $(HOST) $(TEST_CPP) -Itests $(LDFLAGS) $< -o $@ $(TEST_LIBS) $(LINK_SO)

$(BUILD)/tests/api/%: tests/api/%.cpp $(SO) $(SO_LINKS) $(BUILD)/flags
	@mkdir -p $(@D)
	$(call say,TEST,$<)
	$(Q)$(CXX) $(HOST_CXX) $(LDFLAGS) $< -o $@ $(LINK_SO)

$(BUILD)/tests/%: tests/%.c $(SO) $(SO_LINKS) $(BUILD)/flags
	@mkdir -p $(@D)
	$(call say,HOST,$<)
	$(Q)$(CC) $(HOST) -Itests $(LDFLAGS) $< -o $@ $(LINK_SO)

$(BUILD)/examples/%: examples/%.c $(SO) $(SO_LINKS) $(BUILD)/flags
	@mkdir -p $(@D)
	$(call say,HOST,$<)
	$(Q)$(CC) $(HOST) $(LDFLAGS) $< -o $@ $(LINK_SO)

-include $(OBJ:.o=.d) $(addsuffix .d,$(ALL_BIN))

# --- running
demo: $(BUILD)/examples/elastic_bar
	@mkdir -p $(BUILD)/demo
	cd $(BUILD)/demo && $(abspath $<)

check: $(UNIT_BIN) $(API_BIN)
	$(if $(filter file,$(origin CMOCKA)),$(if $(filter 0,$(CMOCKA)),@echo 'cmocka is missing; the built-in harness takes its place: install the Debian package libcmocka-dev'))
	$(if $(HAVE_CXX),,@echo '$(CXX) is missing, C++ hosts are left out: install the Debian package g++')
	@JOBS='$(JOBS)' tests/tools/run_tests.sh '$(TEST_ARGS)' $^

check-long: TEST_ARGS := long
check-long: check

validate validate-long: $(CASE_BIN)
	@JOBS='$(JOBS)' tests/tools/run_validation.sh $(if $(filter %long,$@),long,validate) \
	  $(BUILD)/validation $^

# Instructions a pair, where valgrind is installed.
bench-instructions: $(BENCH_BIN)
	$(call need,valgrind,valgrind)
	@tests/tools/bench_instructions.sh $(BUILD)/tests/bench

bench: $(BENCH_BIN)
	@for b in $^; do $$b $(BENCH_ARGS) || exit 1; done

# --- checks of the contract
# Take the exported names from the public headers.
symbols: $(LIB_A)
	@CC='$(CC)' tests/tools/make_map.sh $(LIB_A) lib/libsph.map lib/abi/symbols.txt

check-headers:
	@CC='$(CC)' CXX='$(CXX)' tests/tools/check_headers.sh $(HEADERS)

check-symbols: $(SO)
	$(call need,nm,binutils)
	@CC='$(CC)' tests/tools/check_symbols.sh $(SO)

check-layers:
	@tests/tools/check_layers.sh

check-readme: $(BUILD)/examples/first_steps
	@tests/tools/check_readme.sh $(abspath $<)

check-abi: $(SO)
	$(call need,abidiff,abigail-tools)
	@tests/tools/check_abi.sh check $(SO)

record-abi: $(SO)
	$(call need,abidw,abigail-tools)
	@tests/tools/check_abi.sh record $(SO)

# Some kernels lay out memory in a way that the sanitizers refuse; setarch -R avoids it.
NO_ASLR := $(shell setarch -R true 2>/dev/null && echo setarch -R)
SANITIZE = $(MAKE) BUILD='$(BUILD)-$(1)' CFLAGS='-O1 -g -fno-omit-frame-pointer -DSPHI_FEW_INSTANCES $(2)' DEFS= \
  LDFLAGS='$(2)' WRAP='$(NO_ASLR)' TIMEOUT=1200

check-asan:
	+@$(call SANITIZE,asan,-fsanitize=address$(comma)undefined -fno-sanitize-recover=all) \
	  TEST_ARGS=short check
# Programs that start no second thread have nothing to show here.
ONE_THREAD := integrate integrate_power kernel kernel_api material_api neighbors_api \
  operators_errors operators_properties particles_api rkc
check-tsan:
	+@$(call SANITIZE,tsan,-fsanitize=thread) SKIP='$(ONE_THREAD) $(SKIP)' TEST_ARGS=short check
comma := ,
export WRAP TIMEOUT

# Another architecture, emulated: no vectors but those of the compiler.
CROSS := aarch64-linux-gnu
check-aarch64:
	$(call need,$(CROSS)-gcc,gcc-$(CROSS))
	$(call need,$(CROSS)-g++,g++-$(CROSS))
	$(call need,qemu-aarch64,qemu-user)
	@test -e /usr/$(CROSS)/include/stdio.h || \
	  { echo 'the C library is missing: install the Debian package libc6-dev-arm64-cross'; exit 1; }
	+@$(MAKE) BUILD='$(BUILD)-aarch64' CC='$(CROSS)-gcc' CXX='$(CROSS)-g++' AR='$(CROSS)-ar' \
	  CFLAGS='-O2 -g -DSPHI_FEW_INSTANCES' WRAP='qemu-aarch64 -L /usr/$(CROSS)' TIMEOUT=1200 \
	  TEST_ARGS=short check

check-valgrind: TEST_ARGS := short
check-valgrind: $(UNIT_BIN) $(API_BIN)
	$(call need,valgrind,valgrind)
	@JOBS='$(JOBS)' TIMEOUT=1800 WRAP='valgrind --quiet --leak-check=full --error-exitcode=9' \
	  tests/tools/run_tests.sh '$(TEST_ARGS)' $^

check-install: lib
	$(call need,pkg-config,pkg-config)
	@CC='$(CC)' CXX='$(CXX)' MAKE='$(MAKE)' BUILD='$(BUILD)' tests/tools/check_install.sh

# The headers under lib/abi are a record: never touched.
FORMATTED = $(shell git ls-files include src tests examples | grep -E '\.(c|cpp|h|inc)$$')
format:
	$(call need,clang-format,clang-format)
	clang-format -i $(FORMATTED)
check-format:
	$(call need,clang-format,clang-format)
	@clang-format --dry-run -Werror $(FORMATTED) && echo 'check-format: fine'

# --- installing
install: lib
	install -d '$(DESTDIR)$(includedir)/sph' '$(DESTDIR)$(libdir)/pkgconfig'
	install -m 644 $(HEADERS) '$(DESTDIR)$(includedir)/sph'
	install -m 755 $(SO) '$(DESTDIR)$(libdir)'
	install -m 644 $(LIB_A) '$(DESTDIR)$(libdir)'
	for l in $(notdir $(SO_LINKS)); do ln -sf $(notdir $(SO)) '$(DESTDIR)$(libdir)'/$$l; done
	sed -e 's|@PREFIX@|$(PREFIX)|' -e 's|@LIBDIR@|$(libdir)|' -e 's|@INCLUDEDIR@|$(includedir)|' \
	  -e 's|@VERSION@|$(VERSION)|' pkgconfig/sph.pc.in > '$(DESTDIR)$(libdir)/pkgconfig/sph.pc'
	chmod 644 '$(DESTDIR)$(libdir)/pkgconfig/sph.pc'

uninstall:
	rm -f $(foreach h,$(notdir $(HEADERS)),'$(DESTDIR)$(includedir)/sph/$(h)')
	rm -f $(foreach l,$(notdir $(SO) $(SO_LINKS) $(LIB_A)),'$(DESTDIR)$(libdir)/$(l)')
	rm -f '$(DESTDIR)$(libdir)/pkgconfig/sph.pc'
	rmdir '$(DESTDIR)$(includedir)/sph' 2>/dev/null || true

clean:
	rm -rf $(BUILD) $(BUILD)-asan $(BUILD)-tsan $(BUILD)-aarch64
	rm -f $(SO) $(SO_LINKS) $(LIB_A)

help:
	@echo 'make                the library (lib/) and the examples (build/examples/)'
	@echo 'make demo           run the elastic bar'
	@echo 'make check          every unit and api test; check-long: with larger sizes'
	@echo 'make validate       every published case, CASE=name for one; validate-long'
	@echo 'make bench          speed: one BENCH line a case; BENCH_ARGS="only=wcsph_rhs dim=3"'
	@echo 'make bench-instructions   instructions a pair (valgrind)'
	@echo 'make check-headers  each public header alone, as C11 and C++11'
	@echo 'make check-symbols  exported names and needed libraries'
	@echo 'make check-layers   no include goes upward'
	@echo 'make check-readme   its program is the example and prints what it says'
	@echo 'make check-abi      against the recorded ABI; record-abi records it'
	@echo 'make symbols        rewrite lib/libsph.map and lib/abi/symbols.txt from the headers'
	@echo 'make check-asan check-tsan check-valgrind   the tests under sanitizers'
	@echo 'make check-aarch64  the tests built for another architecture, under qemu'
	@echo 'make check-install  install elsewhere, use it through pkg-config'
	@echo 'make format check-format   clang-format'
	@echo 'make install uninstall     PREFIX=$(PREFIX), DESTDIR'
	@echo 'make clean'
	@echo 'Variables: CC CFLAGS LDFLAGS V=1 WERROR=1 BUILD FOLDERS TESTS CASE CMOCKA=0 JOBS'
