# Run by embed_texts: writes the table that HEADER declares.
set(text "#include \"${HEADER}\"\n\nconst std::map<std::string, std::string>& mcdem::${FUNCTION}() {\n    static const std::map<std::string, std::string> texts{\n")
foreach(file IN LISTS FILES)
  get_filename_component(name ${file} NAME)
  file(READ ${file} content)
  string(APPEND text "        {\"${name}\", R\"embedded_text(${content})embedded_text\"},\n")
endforeach()
string(APPEND text "    };\n    return texts;\n}\n")
file(WRITE ${OUTPUT} "${text}")
