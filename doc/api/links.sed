# Doxygen's input filter for documents: keeps only the text of links to files outside the API documentation.
s/\[([^]]*)\]\((\.\.|#)[^)]*\)/\1/g
