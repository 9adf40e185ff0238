// Without code: the file for which the headers that all tests share are precompiled (CMakeLists.txt, va_test_support).
