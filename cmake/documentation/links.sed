# Replaces the links of the README by their text, since the documentation of the headers does not contain the linked pages.
s/!?\[([^]]*)\]\([^)]*\)/\1/g
