#include "renderer/files/data_uri.h"

#include <openssl/evp.h>

namespace sheer {

namespace {

std::string base64(std::string_view bytes) {
    std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');  // EVP_EncodeBlock ends with a zero byte
    const int length =
        EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                        reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()));
    text.resize(static_cast<std::size_t>(length));
    return text;
}

}  // namespace

std::string data_uri(const std::string& media_type, std::string_view bytes) {
    return "data:" + media_type + ";base64," + base64(bytes);
}

}  // namespace sheer
