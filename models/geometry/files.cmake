list(APPEND headers)
list(APPEND sources)
