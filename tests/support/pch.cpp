// The object that compiles the precompiled header of the tests.
