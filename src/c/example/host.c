/* What the product needs on a workstation. */

#include <stdio.h>
#include <stdlib.h>

void product(void);

void print(const char *text) {
    fputs(text, stdout);
}

size_t take(void *to, size_t bytes) {
    return fread(to, 1, bytes, stdin);
}

void leave(int status) {
    exit(status);
}

int main(void) {
    product();
    return 0;
}
