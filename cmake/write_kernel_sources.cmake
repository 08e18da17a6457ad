# Run by embed_kernels: writes the table that host/cl/kernel_sources.h declares.
set(text "#include \"cl/kernel_sources.h\"\nnamespace mcdem {\nconst std::map<std::string, std::string>& embedded_kernel_sources() {\n    static const std::map<std::string, std::string> sources{\n")
foreach(kernel IN LISTS KERNELS)
  get_filename_component(name ${kernel} NAME)
  file(READ ${kernel} content)
  string(APPEND text "        {\"${name}\", R\"kernel_source(${content})kernel_source\"},\n")
endforeach()
string(APPEND text "    };\n    return sources;\n}\n}  // namespace mcdem\n")
file(WRITE ${OUTPUT} "${text}")
