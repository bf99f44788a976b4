/* A module that loads slowly: until a file named "go" exists in the folder. Each loading adds a byte to the file
   "began" there. */
#include <fcntl.h>
#include <unistd.h>

extern const int slow_table[];
__attribute__((visibility("default"))) const int slow_table[] = { 3 };

__attribute__((constructor)) static void load_slowly(void)
{
    int began = open("began", O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
    if (began < 0 || write(began, "x", 1) != 1) _exit(99);
    close(began);
    while (access("go", F_OK) != 0) usleep(1000);
}
