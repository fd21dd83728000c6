# What a person types; everything else is CMake (see CMakePresets.json). `make` prints the targets.
JOBS ?= $(shell nproc)
TETRACE = build/release/bin/tetrace
comma := ,
# What the first table compares: a layout of tets and one of a BVH.
first_layouts = half32,bvh2
# QUICK=1: one scene, small images, under a minute once all is built.
scenes = $(if $(QUICK),--scene bunny)

.PHONY: help bench first kernels test test-all sanitize sanitize-threads fuzz build bundle deb release cluster-test format lint clean

help:
	@echo "make bench    install what is missing, build, run the main job; table, JSON, page, pictures (build/bench/);"
	@echo "              QUICK=1: only bunny, in small images"
	@echo "make first    the part of make bench that comes first on a new machine: a small table within minutes"
	@echo "make test     install what is missing, build, run the tests; WERROR=1: a compiler's warning is an error"
	@echo "make test-all the same with the long campaigns: every target of inspect, the whole bundle, random kills"
	@echo "make sanitize the small tests once more, under AddressSanitizer and UndefinedBehaviorSanitizer, then make fuzz;"
	@echo "              ROOMS=core,scenes: only the tests of these folders of tests/"
	@echo "make sanitize-threads  the tests of what has threads that share data, under ThreadSanitizer (clang)"
	@echo "make fuzz     libFuzzer (clang) on what tetrace reads, FUZZ_SECONDS=60 each; TARGETS='ply journal': only those"
	@echo "make build    install what is missing, build build/release/bin/tetrace"
	@echo "make bundle   build build/release/bundle, a folder to copy to a machine with a GPU and run there"
	@echo "make deb      build packages of this Debian: tetrace, libtetrace-dev, and tetrace-builder under licences of its own"
	@echo "make release  all of a release in build/release-files: bundle, small build, packages, container, checksums"
	@echo "make cluster-test  share a run by mpirun, Slurm and GNU parallel, only on this machine; VIEWS=0-1281: all views"
	@echo "make format   format the sources"
	@echo "make lint     check formatting, and the sources with clang-tidy"
	@echo "make clean    remove build/"
	@echo "JOBS=N        compile and test N at a time (here: $(JOBS)); some sources need 2 GB of memory"

build:
	@scripts/install-packages build
	cmake --preset release -G Ninja -DBUILD_TESTING=OFF
	cmake --build --preset release -j $(JOBS)

# A row in error, of a driver that crashes, is in the page too: exit code 1 comes last.
# On a new machine there is a first table before all else is installed and compiled.
bench:
	@[ -e $(TETRACE) ] || $(MAKE) first || echo "The first table failed; going on."
	@$(MAKE) build
	@mkdir -p build/bench
	$(TETRACE) bench $(scenes) $(if $(QUICK),--size 384 --budget 40s) --out build/bench/result.json; status=$$?; \
	    [ $$status -le 1 ] || exit $$status; \
	    $(TETRACE) render $(scenes) --views 0 --picture normals,steps --out build/bench && \
	    pictures=$$(ls build/bench/*.png 2>/dev/null | paste -sd,) && \
	    $(TETRACE) report build/bench/result.json $${pictures:+--image "$$pictures"} --out build/bench/report.html && \
	    echo "Page: build/bench/report.html; result: build/bench/result.json (its schema: results/README.md)" && \
	    exit $$status

# Fewer packages and fewer kernels: without glTF and pictures, for which OpenImageIO brings 200 packages.
first:
	@scripts/install-packages first
	cmake --preset release -G Ninja -DBUILD_TESTING=OFF -DTETRACE_COMPILES=$(first_layouts)
	cmake --build --preset release -j $(JOBS)
	@echo "A first table, of one scene in small images. Then the rest is built, and all of it measured."
	$(TETRACE) bench --scene bunny --layout $(first_layouts),embree,embree_medium,embree_robust --size 256 --samples 7 --budget 40s

bundle: build
	cmake --preset release -DTETRACE_CUDA_CODE=all
	cmake --build --preset release -j $(JOBS) --target bundle

deb: build
	@scripts/install-packages package
	cmake --preset release -DTETRACE_CUDA_CODE=all
	cmake --build --preset release -j $(JOBS)
	cd build/release && cpack
	@ls build/release/*.deb

release: bundle deb
	cmake --preset small -G Ninja
	cmake --build --preset small -j $(JOBS) --target small
	scripts/release build/release build/small build/release-files

cluster-test: build
	@scripts/install-packages cluster
	scripts/cluster-test $(TETRACE) build/cluster

# One test more than processors at a time: some wait for a limit to pass. A machine without CMake is a new one.
test_settings = -DCMAKE_COMPILE_WARNING_AS_ERROR=$(if $(WERROR),ON,OFF)
test test-all:
	@command -v cmake >/dev/null || $(MAKE) kernels
	@scripts/install-packages build test
	cmake --preset release -G Ninja -DBUILD_TESTING=ON $(if $(filter test-all,$@),-DTETRACE_CUDA_CODE=all) $(test_settings)
	cmake --build --preset release -j $(JOBS)
	ctest --preset release -j $$(($(JOBS) + 1)) $(if $(filter test,$@),-LE '^campaign$$') --output-log build/release/test.log; \
	    status=$$?; echo "== release"; scripts/test-summary build/release; exit $$status

# The kernels are compiled while the packages that they do not need arrive. By <&3, sudo can ask for a password.
kernels:
	@scripts/install-packages kernels
	cmake --preset release -G Ninja --log-level=ERROR -DBUILD_TESTING=OFF $(test_settings)
	exec 3<&0; scripts/install-packages build test <&3 & cmake --build --preset release -j $(JOBS) --target tetrace_backends; \
	    status=$$?; wait; exit $$status

sanitize:
	@scripts/install-packages build test
	cmake --preset asan -G Ninja -DBUILD_TESTING=ON -DCMAKE_COMPILE_WARNING_AS_ERROR=$(if $(WERROR),ON,OFF)
	cmake --build --preset asan -j $(JOBS) --target $(if $(ROOMS),$(patsubst %,small_tests_%,$(subst $(comma), ,$(ROOMS))),small_tests)
	ctest --preset asan -j $(JOBS) -L '$(if $(ROOMS),^small-($(subst $(comma),|,$(ROOMS)))$$,small)' --output-log build/asan/test.log; \
	    status=$$?; echo "== asan"; scripts/test-summary build/asan; exit $$status
	$(if $(ROOMS),,$(MAKE) fuzz)

sanitize-threads:
	@scripts/install-packages build test clang
	cmake --preset tsan -G Ninja -DBUILD_TESTING=ON
	cmake --build --preset tsan -j $(JOBS) --target threaded_tests
	archer=$$(ls /usr/lib/llvm-*/lib/libarcher.so | tail -n 1); test -n "$$archer" && \
	    TSAN_OPTIONS=ignore_noninstrumented_modules=1 OMP_NUM_THREADS=4 OMP_TOOL_LIBRARIES=$$archer \
	    ctest --preset tsan -j $(JOBS) -L '^threads-' --output-log build/tsan/test.log; \
	    status=$$?; echo "== tsan"; scripts/test-summary build/tsan; exit $$status

fuzz:
	@scripts/install-packages build test clang
	cmake --preset fuzz -G Ninja -DBUILD_TESTING=ON
	cmake --build --preset fuzz -j $(JOBS) --target fuzzers
	FUZZ_SECONDS=$(or $(FUZZ_SECONDS),60) scripts/fuzz build/fuzz $(TARGETS)

format:
	@scripts/install-packages lint
	scripts/check-format --fix

lint:
	@scripts/install-packages build test lint
	scripts/check-format
	cmake --preset debug -G Ninja -DBUILD_TESTING=ON
	cmake --build --preset debug -j $(JOBS)
	run-clang-tidy -quiet -j $(JOBS) -p build/debug '$(CURDIR)/(core|kernels|backends|scenes|embed|bench|tests)/.*'

clean:
	rm -rf build
