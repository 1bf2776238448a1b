#include <cstdio>

int main() {
  std::puts("tethercalc");
  return 0;
}
