# Writes OUT: a C++ file with every file of FILES (semicolon list) as a string under its path relative to ROOT. See runtime/program.hpp.
set(text "// Made by tools/embed.cmake from kernels/; do not edit.\n#include \"runtime/embedded.hpp\"\nnamespace clvr {\nconst std::map<std::string, std::string>& embedded_kernels() {\n    static const std::map<std::string, std::string> files{\n")
foreach(file IN LISTS FILES)
  file(RELATIVE_PATH name ${ROOT} ${file})
  file(READ ${file} hex HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "\\\\x\\1" bytes "${hex}")
  # One literal a 2000 bytes: compilers limit a single one.
  string(REGEX REPLACE "((\\\\x[0-9a-f][0-9a-f])(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?)" "\"\\1\"\n" literals "${bytes}")
  string(APPEND text "{\"${name}\",\n${literals}},\n")
endforeach()
string(APPEND text "    };\n    return files;\n}\n} // namespace clvr\n")
file(WRITE ${OUT} "${text}")
