# `cpack -G DEB` in the build folder makes a package for Debian 12.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME lumibox)
set(CPACK_PACKAGE_VENDOR "Lumibox")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Firmware of a handheld light field capture box")
set(CPACK_PACKAGE_CONTACT "Lumibox maintainers <root@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# What no program links to: the OpenGL drivers, the letters on the screen, and what steers the signal
# processors of boards, which libcamera loads.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libgl1-mesa-dri, fonts-dejavu-core, libcamera-ipa, systemd, udev")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${CMAKE_SOURCE_DIR}/systemd/postinst
                                       ${CMAKE_SOURCE_DIR}/systemd/prerm)
include(CPack)
