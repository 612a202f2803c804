# What textonbench::methods links to. Read by the build and by the installed package, so that the two agree.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB REQUIRED)
find_package(fmt REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(FFTW REQUIRED IMPORTED_TARGET fftw3f fftw3)
# By pkg-config: the CMake package also insists on OpenImageIO's command-line tools, and so on Qt.
pkg_check_modules(OpenImageIO REQUIRED IMPORTED_TARGET OpenImageIO>=2.4)
find_package(tinyobjloader REQUIRED)
find_package(Ceres REQUIRED)
