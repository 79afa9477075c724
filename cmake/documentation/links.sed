# Links of the README as their text alone: the pages that they lead to are no part of the headers' documentation.
s/!?\[([^]]*)\]\([^)]*\)/\1/g
