# Front door of the workspace. Everything below works from a clean clone with nothing sourced.

SCENARIO          ?= emergency
MODEL             ?= 2d
NODES             ?= auto
OUT               ?= results/$(SCENARIO)
REAL_TIME_FACTOR  ?= 1
EXCHANGE_INTERVAL ?= 0
JOBS              ?= $(shell nproc)
FUZZ_SECONDS      ?= 60

SHELL       := /bin/bash
.SHELLFLAGS := -o pipefail -c

# catkin_make with the system's Python, whatever else is on PATH, and free of the flags of this make.
catkin_make = env -u MAKEFLAGS -u MAKELEVEL -u MAKEOVERRIDES catkin_make --no-color -j$(JOBS) \
  -DPYTHON_EXECUTABLE=/usr/bin/python3
release  = $(catkin_make) -DCMAKE_BUILD_TYPE=Release -DCMAKE_EXPORT_COMPILE_COMMANDS=ON
sanitize = $(catkin_make) --build build_sanitize -DCATKIN_DEVEL_PREFIX=$(CURDIR)/devel_sanitize \
  -DCMAKE_BUILD_TYPE=RelWithDebInfo -DTRAIN_BRAKE_SANITIZE=address,undefined
tsan     = $(catkin_make) --build build_tsan -DCATKIN_DEVEL_PREFIX=$(CURDIR)/devel_tsan \
  -DCMAKE_BUILD_TYPE=RelWithDebInfo -DTRAIN_BRAKE_SANITIZE=thread -DCATKIN_BLACKLIST_PACKAGES=train_brake_rviz

clang    = $(catkin_make) --build build_clang -DCATKIN_DEVEL_PREFIX=$(CURDIR)/devel_clang \
  -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=Release

fuzz     = $(catkin_make) --build build_fuzz -DCATKIN_DEVEL_PREFIX=$(CURDIR)/devel_fuzz \
  -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=RelWithDebInfo \
  -DTRAIN_BRAKE_SANITIZE=fuzzer-no-link,address,undefined -DTRAIN_BRAKE_FUZZ=ON

# What of a build's output is worth reading: the steps and the complaints.
quietly = 2>&1 | sed -uE '/^((Base path|Source space|Build space|Devel space|Install space|Creating symlink|\#\#\#\#|-- |Consolidate compiler)|.*\] Built target )/d'

# All tests of the build folder $(1), each in $(2) seconds at most (1800; it only ends what hangs), or those named $(3); the output of failed ones, and
# "N passed, N failed". /usr/bin comes first, because tools of ROS start "python3".
run_tests = rm -rf $(1)/test_results $(1)/Testing; \
  (cd $(1) && PATH=/usr/bin:$$PATH ctest -j$(JOBS) --timeout $(or $(2),1800) --output-on-failure $(if $(3),-R '$(3)')); \
  tools/test_summary.py $(1)

sources = find src -name '*.h' -o -name '*.cpp'

.PHONY: help
help: ## this list
	@echo "Freight train braking simulator. Targets:"
	@sed -nE 's/^([a-z-]+):.*## (.*)/  make \1\t\2/p' Makefile | expand -t 24
	@echo "Variables of make run: SCENARIO=$(SCENARIO) MODEL=$(MODEL) NODES=$(NODES) OUT=$(OUT)"
	@echo "                       EXCHANGE_INTERVAL=$(EXCHANGE_INTERVAL) (s; 0 = the scenario's)"

.PHONY: deps
deps: ## install the missing Debian packages (tools/packages.txt)
	@tools/install_packages.sh

.PHONY: deps-rviz
deps-rviz: deps ## ... and those that show a train in rviz (tools/packages_rviz.txt)
	@tools/install_packages.sh packages_rviz.txt

.PHONY: deps-test
deps-test: deps-rviz ## ... and those that only the tests need (tools/packages_test.txt)
	@tools/install_packages.sh packages_test.txt

.PHONY: build
build: deps ## build everything (Release) into build/ and devel/
	@$(release) $(quietly)

.PHONY: run
run: build ## launch config/scenarios/$(SCENARIO).yaml as a ROS graph, results and report in $(OUT)
	@. devel/setup.sh && rosrun train_brake run config/scenarios/$(SCENARIO).yaml $(OUT) model:=$(MODEL) nodes:=$(NODES) \
	  exchange_interval:=$(EXCHANGE_INTERVAL)

.PHONY: rviz
rviz: deps-rviz build ## run at REAL_TIME_FACTOR (1; 0 = as fast as possible) and watch it in rviz; ends when rviz is closed
	@[ -n "$$DISPLAY" ] || { echo "make rviz: there is no display here (DISPLAY is not set)" >&2; exit 1; }
	@. devel/setup.sh && rosrun train_brake run config/scenarios/$(SCENARIO).yaml $(OUT) model:=$(MODEL) nodes:=$(NODES) \
	  exchange_interval:=$(EXCHANGE_INTERVAL) rviz:=true start_paused:=true real_time_factor:=$(REAL_TIME_FACTOR) || [ $$? = 130 ]

.PHONY: paper
paper: build ## all scenarios of the paper x three models; its tables and figures beside ours in results/paper/report.html
	@tools/paper.py devel/lib/train_sim/train_sim results/paper

.PHONY: test
test: check-deps deps-test build ## build and run all tests
	@$(release) tests $(quietly)
	@$(call run_tests,build)

.PHONY: test-sanitize
test-sanitize: deps-test ## the same with the address and undefined-behaviour sanitizers, in build_sanitize/
	@$(sanitize) $(quietly)
	@$(sanitize) tests $(quietly)
	@$(call run_tests,build_sanitize,3000)

# Every shipped scenario, for as long as digests.csv says, by the train_sim of the devel folder $(1): to the same bits.
same_digests = . $(1)/setup.bash && PATH=/usr/bin:$$PATH src/train_sim/test/digests_test.py $(1)/lib/train_sim/train_sim config

.PHONY: test-sanitize-short
test-sanitize-short: deps ## train_sim alone with these sanitizers: every shipped scenario, to the same bits
	@$(sanitize) train_sim $(quietly)
	@$(call same_digests,devel_sanitize)

.PHONY: test-clang
test-clang: deps ## train_sim by another compiler (clang), in build_clang/: every shipped scenario, to the same bits
	@tools/install_packages.sh packages_fuzz.txt
	@$(clang) train_sim $(quietly)
	@$(call same_digests,devel_clang)

# Tests in which threads share anything. The rest has one.
threaded = threaded_block_test|recorder_thread_test|run_control_test|shared_slots?_test|wagon_server_test|train_sim_test|resume_test|wire.test|distributed_train.test|unittest_faults|unittest_soak
.PHONY: test-tsan
test-tsan: export TSAN_OPTIONS = history_size=7 suppressions=$(CURDIR)/tools/thread_sanitizer.supp
test-tsan: deps-test ## tests of everything with threads under the thread sanitizer, in build_tsan/
	@$(tsan) $(quietly)
	@$(tsan) tests $(quietly)
	@$(call run_tests,build_tsan,3000,$(threaded))

.PHONY: deps-bench
deps-bench: deps
	@tools/install_packages.sh packages_bench.txt || \
	  echo "make bench: goes on without them; what needs MPI or Valgrind is left out" >&2

.PHONY: bench
bench: deps-bench build ## measure it all, MPI beside it: table here and in docs/performance.md; ONLY=runs,exchange or ONLY=missing for parts, AGAINST=FOLDER (an older build)
	@$(release) train_dynamics_bench train_results_bench $(quietly)
	@. devel/setup.bash; PATH=/usr/bin:$$PATH /usr/bin/python3 tools/bench --only '$(ONLY)' --against '$(AGAINST)'

.PHONY: test-cluster
test-cluster: build ## a train over three machines (network namespaces with sshd; needs root)
	@tools/install_packages.sh packages_cluster.txt
	@tools/test_cluster.sh

# The same Python and ROS as in tests.
in_workspace = . devel/setup.bash && PATH=/usr/bin:$$PATH
.PHONY: test-faults
test-faults: deps-test build ## every fault that a run has to survive, at every time of it; a few minutes (root: with full disks)
	@$(in_workspace) test/faults.py --verbose

.PHONY: test-docs-long
test-docs-long: deps-test build ## every command of the pages, also the long ones, in a clean clone that they build (nightly)
	@PATH=/usr/bin:$$PATH test/docs_pages.py --long Commands

ROUNDS ?= 100
.PHONY: test-soak
test-soak: build ## ROUNDS=100 short trains in a row: nothing may pile up
	@$(in_workspace) test/soak.py $(ROUNDS)

.PHONY: fuzz
fuzz: deps ## hostile input for every parser, FUZZ_SECONDS=60 each (clang), in build_fuzz/
	@tools/install_packages.sh packages_fuzz.txt
	@$(fuzz) fuzzers $(quietly)
	@tools/fuzz.sh build_fuzz devel_fuzz $(FUZZ_SECONDS)

# The programs of the build, installed for where they will lie on other machines.
.PHONY: deb
deb: deps ## Debian packages for users without the source tree, in build_deb/packages/
	@tools/install_packages.sh packages_deb.txt
	@rm -rf build_deb
	@env DESTDIR=$(CURDIR)/build_deb/root $(release) -DCMAKE_INSTALL_PREFIX=/opt/train_brake install $(quietly)
	@tools/deb/make_deb.sh build_deb/root build_deb/packages

.PHONY: test-deb
test-deb: deb ## ... installed, run and removed on a bare Debian 12 (debootstrap; needs root and a Debian mirror)
	@tools/deb/test_deb.sh build_deb/packages

.PHONY: site
site: ## the pages and the C++ API as a site in site/ (MkDocs, Doxygen; no network)
	@tools/install_packages.sh packages_doc.txt packages_site.txt
	@tools/site.py

.PHONY: check-deps
check-deps: ## check who includes whom
	@tools/check_dependencies.sh

.PHONY: reference
reference: build ## renew what is made from the code: docs/configuration.md, result_files.md, ros_interface.md, config/schema/
	@$(in_workspace) && tools/reference.sh

# Python files; those of programs have no ending.
python_sources = git ls-files '*.py' 'src/train_brake/scripts/*' 'src/train_brake_examples/scripts/*'

# Lines of code that are wider than .editorconfig says. (Tables, pages and launch files have no limit.)
line_width = LC_ALL=C.UTF-8 git grep -nE '^.{121,}' -- '*.h' '*.cpp' '*.py' '*.sh' '*.yaml' '*.msg' '*.srv' '*.cmake' '*CMakeLists.txt' 'src/*/scripts/*'

.PHONY: format
format: ## format the code in place (clang-format 14, black)
	@$(sources) | xargs clang-format -i
	@$(python_sources) | xargs black --quiet

.PHONY: check-style
check-style: ## complain about what is not formatted, misspelt, or doubtful in shell scripts and packages
	@tools/install_packages.sh packages_style.txt
	@$(sources) | xargs clang-format --dry-run --Werror
	@$(python_sources) | xargs black --quiet --check || { echo "make format mends these:"; $(python_sources) | xargs black --check; }
	@! $(line_width) || { echo "check-style: lines of more than 120 characters, see above" >&2; exit 1; }
	@git ls-files | grep -v '\.csv$$' | xargs codespell -I tools/spelling_ignored.txt
	@git ls-files '*.sh' .ci/run | xargs shellcheck -S warning
	@catkin_lint --offline -W1 --quiet src

.PHONY: nightly
nightly: test test-clang test-sanitize test-tsan tidy fuzz test-docs-long test-soak ## everything that takes longer than `make test` should

.PHONY: doc
doc: ## reference of the C++ headers in build/doc/html (Doxygen); any warning is an error
	@tools/install_packages.sh packages_doc.txt
	@mkdir -p build && doxygen Doxyfile
	@echo build/doc/html/index.html

# Flags of GCC that clang does not know; laws over lanes, whose conditions know & and | only.
tidy_arguments = -Qunused-arguments -Wno-bitwise-instead-of-logical
.PHONY: tidy
tidy: build ## static analysis (clang-tidy 14)
	@tools/install_packages.sh packages_tidy.txt
	@$(release) tests $(quietly)
	@run-clang-tidy -quiet $(addprefix -extra-arg=,$(tidy_arguments)) -p build '^$(CURDIR)/src/' 2>&1 | sed -uE '/clang-tidy-|warnings? generated\.$$|^Suppressed |^Use -header-filter/d'

SINCE ?= HEAD~1
# The sources that changed since then, or, where the history is not there (a shallow clone), those of one small library.
tidy_short = $(shell git rev-parse -q --verify '$(SINCE)^{commit}' >/dev/null \
  && git diff --name-only --diff-filter=ACMR $(SINCE) -- 'src/*/src/*.cpp' || git ls-files 'src/strict_config/src/*.cpp')
.PHONY: tidy-short
tidy-short: deps-rviz build ## ... of the sources (without tests) that changed since the commit SINCE=HEAD~1
	@tools/install_packages.sh packages_tidy.txt
	@echo 'clang-tidy:' $(tidy_short)
	@echo $(tidy_short) | xargs -r -n 1 -P $(JOBS) clang-tidy --quiet $(addprefix --extra-arg=,$(tidy_arguments)) -p build

.PHONY: clean
clean: ## remove everything built; results stay
	@rm -rf build devel install build_sanitize devel_sanitize build_tsan devel_tsan build_fuzz devel_fuzz build_clang devel_clang build_deb build_site site src/CMakeLists.txt .catkin_workspace
