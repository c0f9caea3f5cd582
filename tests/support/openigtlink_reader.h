// Lets OpenIGTLink's own library read what we send.
#pragma once

#include <igtlMessageBase.h>
#include <igtlMessageHeader.h>

#include <cstring>
#include <string>

#include "common/igtl_wire/igtl_frame.h"

namespace bonemill::test {

// Reads the whole frame, with its checksum; null where the library does not believe it.
template <class Message>
typename Message::Pointer readByLibrary(const std::string& frame) {
    auto header = ::igtl::MessageHeader::New();
    header->InitPack();
    std::memcpy(header->GetPackPointer(), frame.data(), size_t(header->GetPackSize()));
    header->Unpack();
    auto message = Message::New();
    message->SetMessageHeader(header);
    message->AllocatePack();
    if (size_t(message->GetPackBodySize()) != frame.size() - igtl::kHeaderBytes) return nullptr;
    std::memcpy(message->GetPackBodyPointer(), frame.data() + igtl::kHeaderBytes,
                frame.size() - igtl::kHeaderBytes);
    return message->Unpack(1) & ::igtl::MessageHeader::UNPACK_BODY ? message : nullptr;
}

}  // namespace bonemill::test
