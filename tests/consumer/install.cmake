# Install BUILD into an empty PREFIX: what an earlier install left must not hide what this one lacks.
file(REMOVE_RECURSE ${PREFIX})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${PREFIX} COMMAND_ERROR_IS_FATAL ANY)
foreach(program makevismap makecfem makelightmap)
  execute_process(COMMAND ${PREFIX}/${BINDIR}/${program} --version COMMAND_ERROR_IS_FATAL ANY)
endforeach()
