# Run by cmake -P: OUTPUT becomes a header with the text of each of INPUTS (separated by |) as a
# string_view in chladni::report::page_parts: plot.js is `plot_js`. `scripts` are all that end in .js, in
# their order.
string(REPLACE "|" ";" INPUTS "${INPUTS}")
set(header "#pragma once\n\n#include <string_view>\n\nnamespace chladni::report::page_parts {\n\n")
set(scripts "")
foreach(input IN LISTS INPUTS)
  file(READ ${input} hex HEX)
  # Bytes as numbers: a literal of any length, whatever the text holds.
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
  get_filename_component(name ${input} NAME)
  string(MAKE_C_IDENTIFIER ${name} name)
  string(APPEND header "inline constexpr unsigned char ${name}_bytes[] = {${bytes}};\n"
                       "inline const std::string_view ${name}(\n"
                       "    reinterpret_cast<const char*>(${name}_bytes), sizeof ${name}_bytes);\n\n")
  if(name MATCHES "_js$")
    list(APPEND scripts ${name})
  endif()
endforeach()
list(JOIN scripts ", " scripts)
string(APPEND header "inline const std::string_view scripts[] = {${scripts}};\n\n")
string(APPEND header "}  // namespace chladni::report::page_parts\n")
file(WRITE ${OUTPUT} "${header}")
