# SOURCE, a text, as a string literal of C++ in TARGET.
file(READ ${SOURCE} text)
file(WRITE ${TARGET} "R\"table(${text})table\"\n")
