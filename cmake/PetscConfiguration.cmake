# Refuses a PETSc whose numbers or indices are not those of Chladni: doubles and 32-bit integers.

# check_petsc_configuration(FOLDERS): those where PETSc's headers are.
function(check_petsc_configuration folders)
  list(REMOVE_ITEM folders "")
  list(REMOVE_DUPLICATES folders)
  find_file(PETSC_CONFIGURATION petscconf.h PATHS ${folders} NO_DEFAULT_PATH NO_CACHE)
  if(NOT PETSC_CONFIGURATION)
    message(FATAL_ERROR "petsc.pc names the folders ${folders}, but none of them has petscconf.h: build PETSC_DIR first, "
                        "or unset it to take the PETSc of the system")
  endif()
  file(STRINGS ${PETSC_CONFIGURATION} uses REGEX "^#define PETSC_USE_")
  set(refused "")
  foreach(pair "COMPLEX|complex numbers|--with-scalar-type=complex"
               "64BIT_INDICES|64-bit indices|--with-64-bit-indices"
               "REAL_SINGLE|single precision|--with-precision=single"
               "REAL___FLOAT128|quadruple precision|--with-precision=__float128"
               "REAL___FP16|half precision|--with-precision=__fp16")
    string(REPLACE "|" ";" pair "${pair}")
    list(GET pair 0 name)
    list(GET pair 1 what)
    list(GET pair 2 option)
    if(uses MATCHES "PETSC_USE_${name} ")
      string(APPEND refused "\n  ${what}: configure PETSc without ${option}")
    endif()
  endforeach()
  if(refused)
    message(FATAL_ERROR "${PETSC_CONFIGURATION} is that of a PETSc with${refused}\nChladni needs real numbers in double "
                        "precision and 32-bit indices. Set PETSC_DIR, PETSC_ARCH and SLEPC_DIR to such a PETSc, or unset "
                        "them to take that of the system (Debian: libpetsc-real-dev, libslepc-real-dev)")
  endif()
endfunction()
