// The addresses that a server can have: ports, Unix sockets, TLS.
#include "tests/view/serving.hpp"

#include <gmock/gmock.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>

#include <sys/stat.h>

namespace clvr::view {
namespace {

using test::error_of;
using testing::HasSubstr;

class Address : public Serving {
protected:
    Error refusal() {
        return error_of([&] { Server{settings}; });
    }
    static unsigned mode(const std::string& path) {
        struct stat found {};
        return stat(path.c_str(), &found) == 0 ? found.st_mode & 0777 : 0;
    }
};

TEST_F(Address, PortIsAnyFreeOneOrTheOneWanted) {
    const int any = start();
    EXPECT_GT(any, 0);
    server.reset();
    settings.port = any;
    EXPECT_EQ(start(), any);
}

TEST_F(Address, PortInUseIsSaid) {
    settings.port = start();
    const Error e = refusal();
    EXPECT_EQ(e.kind(), ErrorKind::usage);
    EXPECT_EQ(e.where(), "--port");
    EXPECT_THAT(e.line(), HasSubstr("is in use"));
}

TEST_F(Address, HostMustBeThisMachines) {
    settings.host = "no address";
    EXPECT_EQ(refusal().where(), "--host");
    settings.host = "192.0.2.1"; // a documentation address
    EXPECT_EQ(refusal().where(), "--port");
}

TEST_F(Address, IsLoopbackAlone) {
    const int port = start();
    Connection other(port);
    EXPECT_TRUE(other.connected());
    sockaddr_in bound{};
    socklen_t size = sizeof bound;
    ASSERT_EQ(getpeername(other.descriptor(), reinterpret_cast<sockaddr*>(&bound), &size), 0);
    EXPECT_EQ(ntohl(bound.sin_addr.s_addr), INADDR_LOOPBACK);
}

TEST_F(Address, SocketIsForItsOwnerAlone) {
    settings.socket = folder / "new/view.sock";
    EXPECT_EQ(start(), 0);
    EXPECT_EQ(mode(folder / "new"), 0700u);
    EXPECT_EQ(mode(settings.socket), 0600u);
    EXPECT_EQ(request(settings.socket, request_text("GET", "/")).status, 200);
    EXPECT_EQ(request(settings.socket, request_text("GET", "/", "", "evil.example")).status, 403);
    Page page = joined(settings.socket);
    server->stop("bye");
    EXPECT_FALSE(std::filesystem::exists(settings.socket));
}

TEST_F(Address, SocketInUseIsLeftAlone) {
    settings.socket = folder / "new/view.sock";
    start();
    EXPECT_THAT(refusal().line(), HasSubstr("is in use"));
    EXPECT_EQ(request(settings.socket, request_text("GET", "/")).status, 200);
}

TEST_F(Address, SocketThatNobodyListensToIsReplaced) {
    settings.socket = folder / "view.sock";
    const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    settings.socket.copy(address.sun_path, sizeof address.sun_path - 1);
    ASSERT_EQ(bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    close(fd);
    start();
    EXPECT_EQ(request(settings.socket, request_text("GET", "/")).status, 200);
}

TEST_F(Address, SocketElsewhereIsRefused) {
    settings.socket = folder / "file";
    test::put(settings.socket, "precious");
    EXPECT_THAT(refusal().line(), HasSubstr("is no socket"));
    EXPECT_EQ(test::bytes_of(settings.socket), "precious");
    settings.socket = folder / "file/x";
    EXPECT_EQ(refusal().kind(), ErrorKind::usage);
    settings.socket = folder / "no/folder/x";
    EXPECT_THAT(refusal().line(), HasSubstr("cannot be made"));
    settings.socket = folder / std::string(200, 'x');
    EXPECT_THAT(refusal().line(), HasSubstr("is longer than"));
    std::filesystem::create_directory(folder / "open");
    chmod((folder / "open").c_str(), 0755);
    settings.socket = folder / "open/x";
    EXPECT_THAT(refusal().line(), HasSubstr("other users get into"));
}

/// A key, and a certificate for localhost that it signs itself.
void write_certificate(const std::string& certificate, const std::string& key) {
    EVP_PKEY* const pair = EVP_EC_gen("P-256");
    X509* const x = X509_new();
    ASN1_INTEGER_set(X509_get_serialNumber(x), 1);
    X509_gmtime_adj(X509_getm_notBefore(x), 0);
    X509_gmtime_adj(X509_getm_notAfter(x), 3600);
    X509_set_pubkey(x, pair);
    X509_NAME_add_entry_by_txt(X509_get_subject_name(x), "CN", MBSTRING_ASC, reinterpret_cast<const unsigned char*>("localhost"), -1, -1,
                               0);
    X509_set_issuer_name(x, X509_get_subject_name(x));
    X509_sign(x, pair, EVP_sha256());
    FILE* file = fopen(certificate.c_str(), "w");
    PEM_write_X509(file, x);
    fclose(file);
    file = fopen(key.c_str(), "w");
    PEM_write_PrivateKey(file, pair, nullptr, nullptr, 0, nullptr, nullptr);
    fclose(file);
    X509_free(x);
    EVP_PKEY_free(pair);
}

/// The first bytes of the answer over TLS.
std::string over_tls(int port, const std::string& text) {
    Connection connection(port);
    SSL_CTX* const context = SSL_CTX_new(TLS_client_method());
    SSL* const tls = SSL_new(context);
    SSL_set_fd(tls, connection.descriptor());
    std::string answer(15, '\0');
    if (SSL_connect(tls) == 1) {
        SSL_write(tls, text.data(), static_cast<int>(text.size()));
        SSL_read(tls, answer.data(), static_cast<int>(answer.size()));
    }
    SSL_free(tls);
    SSL_CTX_free(context);
    return answer;
}

TEST_F(Address, TlsIsSpokenWithACertificate) {
    settings.certificate = folder / "cert.pem", settings.key = folder / "key.pem";
    write_certificate(settings.certificate, settings.key);
    const int port = start();
    EXPECT_EQ(over_tls(port, request_text("GET", "/")), "HTTP/1.1 200 OK");
    const std::string upgrade = "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                                "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n";
    EXPECT_EQ(over_tls(port, request_text("GET", "/socket", upgrade + own_origin)), "HTTP/1.1 101 Sw");
    EXPECT_EQ(over_tls(port, request_text("GET", "/socket", upgrade)), "HTTP/1.1 403 Fo");
    EXPECT_EQ(request(port, request_text("GET", "/")).status, 0); // not without
}

TEST_F(Address, FilesThatAreNoCertificateOrKeyAreRefused) {
    settings.certificate = folder / "cert.pem", settings.key = folder / "key.pem";
    EXPECT_EQ(refusal().where(), settings.certificate);
    write_certificate(settings.certificate, settings.key);
    test::put(settings.key, "no key");
    EXPECT_EQ(refusal().where(), settings.key);
    EXPECT_EQ(refusal().kind(), ErrorKind::input);
}

} // namespace
} // namespace clvr::view
