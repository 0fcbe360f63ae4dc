#!/bin/bash
# Install to a scratch folder, then compile and run a C and a C++ host outside the tree through
# pkg-config, with the shared and with the static library; uninstall must leave no file.
set -euo pipefail
cd "$(dirname "$0")/../.."
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
make=${MAKE:-make}
$make --no-print-directory BUILD="${BUILD:-build}" PREFIX="$dir/usr" install > "$dir/log"
export PKG_CONFIG_PATH="$dir/usr/lib/pkgconfig"

cat > "$dir/host.c" << 'HOST'
#include <sph/sph.h>
#include <stdio.h>
#include <string.h>
int main(void) {
  sph_context_options options;
  sph_context *ctx = NULL;
  char version[32];
  sph_context_options_init(&options);
  if (sph_context_create(&options, &ctx) != SPH_OK) return 1;
  snprintf(version, sizeof version, "%d.%d.%d", SPH_VERSION_MAJOR, SPH_VERSION_MINOR,
           SPH_VERSION_PATCH);
  sph_context_destroy(ctx);
  return strcmp(version, sph_version_string()) != 0;
}
HOST
cp "$dir/host.c" "$dir/host.cc"
cd "$dir"
build() { # NAME COMPILER SOURCE FLAGS...
  local name=$1 compiler=$2 source=$3
  shift 3
  # shellcheck disable=SC2046,SC2086
  $compiler -Wall -Wextra -Wpedantic -Werror $(pkg-config --cflags sph) "$source" -o "$name" "$@"
}
libdir=$dir/usr/lib
build c_shared "${CC:-cc} -std=c11" host.c $(pkg-config --libs sph)
build cxx_shared "${CXX:-c++} -std=c++11" host.cc $(pkg-config --libs sph)
ldd c_shared | grep -q "$libdir/libsph.so" 2>/dev/null || export LD_LIBRARY_PATH="$libdir"
./c_shared
./cxx_shared
# The archive alone: the linker would prefer the shared object beside it.
mkdir shared && mv "$libdir"/libsph.so* shared/
build c_static "${CC:-cc} -std=c11" host.c $(pkg-config --static --libs sph)
build cxx_static "${CXX:-c++} -std=c++11" host.cc $(pkg-config --static --libs sph)
unset LD_LIBRARY_PATH
./c_static
./cxx_static
mv shared/libsph.so* "$libdir/"
[ "$(pkg-config --modversion sph)" = "$(readlink "$libdir/libsph.so" | sed 's/libsph.so.//')" ]

cd - > /dev/null
$make --no-print-directory BUILD="${BUILD:-build}" PREFIX="$dir/usr" uninstall > "$dir/log"
left=$(find "$dir/usr" -type f -o -type l)
[ -z "$left" ] || { echo "uninstall leaves:" $left; exit 1; }
echo 'check-install: C and C++ hosts run with the shared and the static library'
