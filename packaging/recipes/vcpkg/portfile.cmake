vcpkg_download_distfile(archive
    URLS "https://pypi.org/packages/source/l/lensprof/lensprof-${VERSION}.tar.gz"
    FILENAME "lensprof-${VERSION}.tar.gz"
    SHA512 1bd86231a2cbf6fcb7a0962b4199737051e92892b09464298296980767fa850fd430a90da2672516213692f95e351217c390c869f649806f524f641c5e2e383e
)
vcpkg_extract_source_archive(source ARCHIVE "${archive}")
vcpkg_find_acquire_program(PKGCONFIG)
vcpkg_cmake_configure(
    SOURCE_PATH "${source}"
    OPTIONS -DLENSPROF_PHOTO=OFF -DLENSPROF_PROGRAM=OFF -DLENSPROF_TESTS=OFF "-DPKG_CONFIG_EXECUTABLE=${PKGCONFIG}"
)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/lensprof)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include")
vcpkg_install_copyright(FILE_LIST "${source}/LICENSE" "${source}/NOTICE")
