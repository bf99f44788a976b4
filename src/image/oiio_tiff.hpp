/* oiio_tiff.hpp - what libtiff could not write. C++, part of the module alone.
   Private to this room.

   libtiff tells nobody but a handler what goes wrong when it closes a file. OpenImageIO brings it along; its one
   function that is needed is declared here. */
#pragma once
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstring>

extern "C" void *TIFFSetErrorHandlerExt(void (*handler)(void *, const char *, const char *,
                                                        va_list)) __attribute__((weak));

/* The first complaint of this thread since it was emptied, and what the system had said before it. */
inline thread_local char tiff_error[256];
inline thread_local int tiff_errno;

inline void forget_tiff_error()
{
    tiff_error[0] = '\0';
    tiff_errno = errno = 0;
}

/* A tag that it does not know was left out on purpose (forbid_date), or is no loss. */
inline void on_tiff_error(void *, const char *from, const char *format, va_list list)
{
    if (from && std::strstr(from, "SetField")) return;
    bool disk = errno == EFBIG || errno == ENOSPC || errno == EDQUOT || errno == EIO;
    if (!tiff_errno && disk) tiff_errno = errno;
    if (!tiff_error[0]) vsnprintf(tiff_error, sizeof tiff_error, format, list);
}

inline void listen_to_tiff()
{
    if (TIFFSetErrorHandlerExt) TIFFSetErrorHandlerExt(on_tiff_error);
}
