// Compiled only for its precompiled header, which the test programs share.
