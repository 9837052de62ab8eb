/* Both interfaces in one file of C99. */
#include <relevo/plugin.h>
#include <relevo/relevo.h>

int headers_compile(void);
int headers_compile(void) {
    relevo_picture picture = {.size = sizeof picture};
    return (int)picture.size;
}
