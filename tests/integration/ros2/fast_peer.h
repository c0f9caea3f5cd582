// A node as ROS 2 with Fast DDS would be it, made of the published message definitions alone: it knows topics
// and types by their names, and messages as bytes, which it takes apart or puts together itself. Nothing of
// proto/ros2.idl or of Cyclone DDS is in it.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace bonemill::test {

// Reads plain CDR, little endian, as ROS 2 writes it: every number at a multiple of its own size behind the
// four bytes that say how it is coded. Beyond the end everything is 0 and isWhole() is false.
class CdrBytes {
  public:
    explicit CdrBytes(std::vector<uint8_t> bytes);

    double f64() { return number<double>(); }
    float f32() { return number<float>(); }
    int32_t i32() { return number<int32_t>(); }
    uint32_t u32() { return number<uint32_t>(); }
    bool flag() { return number<uint8_t>() == 1; }
    std::string text();  // its length counts the 0 at its end
    // It was plain CDR, and it ends here but for what fills up to a multiple of four.
    bool isWhole() const { return is_good_ && bytes_.size() - at_ < 4; }
    const std::vector<uint8_t>& bytes() const { return bytes_; }

  private:
    template <class Number>
    Number number();
    bool skipTo(size_t alignment, size_t bytes);

    std::vector<uint8_t> bytes_;
    size_t at_ = 4;
    bool is_good_ = false;
};

// Puts such bytes together.
class CdrMaker {
  public:
    CdrMaker& f64(double value) { return put(value); }
    CdrMaker& i32(int32_t value) { return put(value); }
    CdrMaker& u32(uint32_t value) { return put(value); }
    CdrMaker& text(const std::string& text);
    const std::vector<uint8_t>& bytes() const { return bytes_; }

  private:
    template <class Number>
    CdrMaker& put(Number value);

    std::vector<uint8_t> bytes_{0, 1, 0, 0};
};

struct RosQos {
    bool is_reliable = true;
    bool is_transient_local = false;
    int depth = 10;
};

class FastNode {
  public:
    // Only on this PC, as with ROS_LOCALHOST_ONLY=1; else on all its networks, as nodes are by default.
    explicit FastNode(uint32_t domain, bool is_localhost_only = true);
    ~FastNode();

    // They belong to the node, and go with it.
    class Reader {
      public:
        // What has come since the last call, the bytes of a message each.
        std::vector<std::vector<uint8_t>> take();
        int matchedWriters() const;

      private:
        friend class FastNode;
        struct Inside;
        std::shared_ptr<Inside> inside_;
    };
    // The topic by DDS' name, "rt/bonemill/tf"; the type by DDS' name, "std_msgs::msg::dds_::String_".
    Reader read(const std::string& topic, const std::string& type, const RosQos& qos = {});

    class Writer {
      public:
        void write(const std::vector<uint8_t>& bytes);
        int matchedReaders() const;

      private:
        friend class FastNode;
        struct Inside;
        std::shared_ptr<Inside> inside_;
    };
    Writer writer(const std::string& topic, const std::string& type, const RosQos& qos = {});

  private:
    struct Inside;
    std::unique_ptr<Inside> inside_;
};

}  // namespace bonemill::test
