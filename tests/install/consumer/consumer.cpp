// The same from C++: the headers' functions have C linkage there.
#include <iostream>
#include <memory>

#include <lensprof/lensprof.h>

int main() {
    const char text[] = "p f2 w100 h50 v360\ni w10 h8 f0 v50 Eev0 n\"a.png\"\nv Eev0\nv\n";
    lensprof_pto *pto = nullptr;
    lensprof_error error{};
    if (lensprof_pto_read(text, sizeof text - 1, &pto, &error) != LENSPROF_OK) return 1;
    std::unique_ptr<lensprof_pto, void (*)(lensprof_pto *)> owner(pto, lensprof_pto_destroy);
    lensprof_response response;
    if (lensprof_response_set_gamma(&response, 2.0) != LENSPROF_OK) return 2;
    if (lensprof_response_eval(&response, 1.0, nullptr) != 1.0) return 3;
    std::cout << "lensprof " << lensprof_version() << " from C++\n";
}
