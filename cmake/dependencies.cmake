# The third-party packages, all from Debian 12. PELLUCID_LINKED are the libraries whose code the library needs when a
# program is linked; header-only packages give only their include folder and so never reach a consumer of the package.
find_package(Threads REQUIRED)
find_package(glm REQUIRED)
find_package(embree 3 REQUIRED)
set(CMAKE_MESSAGE_LOG_LEVEL WARNING) # its Imath remarks at length on a Python module that nobody asked for
find_package(OpenImageIO 2.4 REQUIRED)
find_package(OpenEXR 3 REQUIRED) # its limits alone: pictures are read and written by OpenImageIO
unset(CMAKE_MESSAGE_LOG_LEVEL)
find_package(TinyGLTF REQUIRED)
find_package(fmt REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(nanoflann REQUIRED)
find_package(CLI11 REQUIRED)
if(NOT PELLUCID_STD_THREADS)
    find_package(TBB REQUIRED)
endif()

# Debian's OpenImageIO target names the headers of opencv4, which the package neither needs nor installs; CMake
# refuses a target with a missing include folder.
foreach(property INTERFACE_INCLUDE_DIRECTORIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES)
    get_target_property(folders OpenImageIO::OpenImageIO ${property})
    if(folders)
        list(FILTER folders EXCLUDE REGEX "/opencv4$")
        set_target_properties(OpenImageIO::OpenImageIO PROPERTIES ${property} "${folders}")
    endif()
endforeach()

set(PELLUCID_LINKED embree OpenImageIO::OpenImageIO OpenEXR::OpenEXR TinyGLTF::TinyGLTF fmt::fmt tomlplusplus::tomlplusplus)
if(NOT PELLUCID_STD_THREADS)
    list(APPEND PELLUCID_LINKED TBB::tbb)
endif()

# Gives a target the headers of a header-only package without a trace in its exported link interface.
function(pellucid_headers target package)
    target_include_directories(${target} SYSTEM PRIVATE $<TARGET_PROPERTY:${package},INTERFACE_INCLUDE_DIRECTORIES>)
endfunction()
